// The text of reports and of faults: the lines that the app prints and reads.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "app/laboratory/fakes.h"
#include "app/run/percentiles.h"
#include "app/run/run_report.h"
#include "app/stability_text.h"
#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/refusal.h"

namespace enc::app {
namespace {

using certificate::Class, certificate::Row;
using testing::AllOf, testing::ContainsRegex, testing::HasSubstr, testing::Not;
using trial::ObjectCertificate;

// The report prints a percentile if there are enough values for it, and always prints the largest value.

std::string of(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), 1.0);
  return text_of(percentiles_of(values), 1.0, 0, 0);
}

TEST(Percentiles, NeedAValueBeyondThem) {
  EXPECT_EQ(of(0), "none");
  EXPECT_EQ(of(1), "max 1");
  EXPECT_EQ(of(9), "max 9");
  EXPECT_EQ(of(10), "p50 5, max 10");
  EXPECT_EQ(of(99), "p50 50, max 99");
  EXPECT_EQ(of(100), "p50 50, p99 99, max 100");
  EXPECT_EQ(of(999), "p50 500, p99 989, max 999");
  EXPECT_EQ(of(1000), "p50 500, p99 990, p99.9 999, max 1000");
}

TEST(Percentiles, AreKnownOnBothSides) {
  for (const auto& [share, count] :
       {std::pair{0.5, 10U}, {0.95, 20U}, {0.05, 20U}, {0.975, 40U}, {0.99, 100U}, {0.999, 1000U}}) {
    EXPECT_TRUE(models::has_percentile(count, share)) << share;
    EXPECT_FALSE(models::has_percentile(count - 1, share)) << share;
  }
  EXPECT_TRUE(models::has_percentile(1, 1.0));
  EXPECT_TRUE(models::has_percentile(1, 0.0));
  EXPECT_FALSE(models::has_percentile(0, 1.0));
}

// Text and JSON report of a run with this many ticks.
std::pair<std::string, nlohmann::json> reports_of(double ticks) {
  const models::Setup setup = models::load(tests::source_dir() + "/models/scenes/plane.toml", "sim");
  trial::TrialOptions options{.seconds = 1e-3 * (ticks - 1.0)};
  trial::RunMeasures measured{setup, options};
  trial::Trial trial(setup, options);
  const trial::TrialResult result = trial.run();
  const std::vector<trial::ArmStrength> strengths;
  const std::vector<trial::ObjectCertificate> certificates;
  const RunOptions asked;
  const RunReport report{setup, trial.scene(), result, measured, strengths, certificates, asked};
  return {run_text(report), nlohmann::json::parse(run_json(report))};
}

TEST(Percentiles, OfAShortRunAreLeftOutOfTextAndJson) {
  const auto [text, json] = reports_of(60);
  EXPECT_THAT(text, ::testing::ContainsRegex("\ntick        step\\(\\) p50 [0-9.]+, max [0-9.]+ us\n"));
  const nlohmann::json& step = json.at("step_ns");
  EXPECT_TRUE(step.at("p50").is_number());
  EXPECT_TRUE(step.at("p99").is_null());
  EXPECT_TRUE(step.at("p99_9").is_null());
  EXPECT_TRUE(step.at("max").is_number());
}

TEST(Percentiles, OfALongRunAreAllThere) {
  const auto [text, json] = reports_of(1000);
  EXPECT_THAT(text,
              ::testing::ContainsRegex(
                  "\ntick        step\\(\\) p50 [0-9.]+, p99 [0-9.]+, p99.9 [0-9.]+, max [0-9.]+ us\n"));
  EXPECT_TRUE(json.at("step_ns").at("p99_9").is_number());
}

// The report's line about a run's speed.

TEST(SpeedText, ASlowRunHasTwoDigits) {
  EXPECT_EQ(speed_text(1.0, 12.5), "0.08");
  EXPECT_EQ(speed_text(24.0, 10.0), "2.4");
  EXPECT_EQ(speed_text(84.45, 0.553), "153");
  EXPECT_EQ(speed_text(1.0, 0.0), "0");
}

// The report's lines about holds: it lists the first three and counts the rest.

// The force sensor is at fault this many times, for 5 ms each.
struct FaultyRun {
  explicit FaultyRun(int times) {
    options.seconds = 0.05 + 0.01 * times;
    options.disturb = [times, tick = 0](Inputs& in) mutable {
      ++tick;
      if (tick % 10 < 5 && tick >= 10 && tick / 10 <= times) in.wrench.health = Health::fault;
    };
    trial::Trial trial(setup, options);
    result = trial.run();
    text = run_text({setup, trial.scene(), result, measured, strengths, certificates, asked});
  }
  [[nodiscard]] int lines(const std::string& begin) const {
    int count = 0;
    for (std::size_t at = text.find("\n" + begin); at != std::string::npos;
         at = text.find("\n" + begin, at + 1))
      ++count;
    return count;
  }

  models::Setup setup = models::load(tests::source_dir() + "/models/scenes/tennis_ball.toml", "sim");
  trial::TrialOptions options;
  trial::RunMeasures measured{setup, options};
  std::vector<trial::ArmStrength> strengths;
  std::vector<trial::ObjectCertificate> certificates;
  RunOptions asked;
  trial::TrialResult result;
  std::string text;
};

TEST(HoldLines, TheFirstThreeAreSaidAndTheOthersCounted) {
  for (const auto& [times, more] : {std::pair{0, ""},
                                    {3, ""},
                                    {4, "\nhold        and 1 time more; 0.020 s in all\n"},
                                    {40, "\nhold        and 37 times more; 0.200 s in all\n"}}) {
    SCOPED_TRACE(times);
    const FaultyRun held(times);
    EXPECT_EQ(held.result.times_held, times);
    EXPECT_EQ(held.result.holds.size(), std::min<std::size_t>(16, static_cast<std::size_t>(times)));
    EXPECT_EQ(held.lines("hold        at "), std::min(3, times));
    EXPECT_EQ(held.lines("hold        and "), times > 3 ? 1 : 0);
    EXPECT_THAT(held.text, testing::HasSubstr(more));
  }
}

// `check` shows the bounds of the object that is nearest to its bound. Equal margins always give the same
// object.

ObjectCertificate one(const std::string& object, Class verdict, double margin,
                      const std::string& row = "exact_with_hand") {
  ObjectCertificate made{object, 600.0, {}};
  made.certificate.verdict = verdict;
  made.certificate.rows.push_back({row, "|z| < 1", 600.0 * margin, margin, true, "test"});
  return made;
}

std::string shown(const std::vector<ObjectCertificate>& all) { return nearest_its_bound(all).object; }

TEST(StabilityText, TheRowsAreOfTheOneThatIsNearestToItsBound) {
  const ObjectCertificate tip = one("", Class::alone, 2.0), a = one("a", Class::alone, 2.0),
                          b = one("b", Class::alone, 1.5);
  EXPECT_EQ(shown({tip, a, b}), "b");
  EXPECT_EQ(shown({tip, a, one("c", Class::alone, 2.0)}), "a") << "of equal ones the first";
  EXPECT_EQ(shown({tip, a}), "a") << "and an object before the free tip";
  EXPECT_EQ(shown({tip, one("c", Class::alone, 3.0)}), "");
  EXPECT_EQ(shown({tip, b, one("u", Class::unknown, NAN)}), "u") << "what is not known before what is";
  const ObjectCertificate over = one("o", Class::unstable, 0.9), far = one("f", Class::unstable, 0.2);
  EXPECT_EQ(shown({tip, one("u", Class::unknown, NAN), over, far}), "f")
      << "what is beyond first, the farthest";
  ObjectCertificate copy = a;
  copy.object = "z";
  copy.like = "a";
  EXPECT_EQ(shown({copy, a}), "a") << "whose own they are";
  EXPECT_EQ(shown({a, one("p", Class::alone, 1.0, "gil_hulin")}), "a") << "a formula to compare is no bound";
}

TEST(StabilityText, WhereASearchEndedOneSideIsKnown) {
  const models::Setup setup;
  ObjectCertificate soft = one("soft", Class::alone, 2.0, "large_signal");
  Row& row = soft.certificate.rows.front();
  row.bound = INFINITY;
  row.low = 88.5;
  soft.ramp = 0.5;
  EXPECT_THAT(stability_text(setup, {soft}), ContainsRegex("large_signal +from 0.0885 +2 x "));
  row.side = Row::Side::below;
  EXPECT_THAT(stability_text(setup, {soft}), ContainsRegex("large_signal +from < 0.0885 +> 2 x "));
  row.side = Row::Side::above;
  row.margin = 1.0;
  EXPECT_THAT(stability_text(setup, {soft}), ContainsRegex("large_signal +from > 0.0885 +< 1 x "));
}

TEST(StabilityText, WhatIsNotKnownIsNotSaidToBeBeyond) {
  models::Setup setup;
  ObjectCertificate unknown = one("a", Class::unknown, NAN);
  unknown.certificate.missing = "damping";
  EXPECT_THAT(
      stability_text(setup, {unknown}),
      AllOf(HasSubstr("NOT KNOWN: whether object 'a' is stable is not known: no damping; write [arm.loop]"),
            Not(HasSubstr("BEYOND"))));
  setup.rig.arm.loop.emplace();
  const auto said = [&](const char* missing) {
    unknown.certificate.missing = missing;
    return stability_text(setup, {unknown});
  };
  EXPECT_THAT(said("damping"),
              AllOf(HasSubstr("no damping; correct 'viscous_Nms'"), Not(HasSubstr("write"))));
  EXPECT_THAT(said("friction"), HasSubstr("correct 'friction_Nm' in its [arm.loop]"));
  EXPECT_THAT(said("encoder step"), HasSubstr("correct 'counts'"));
  EXPECT_THAT(said("hand's damping"), HasSubstr("'hand_damping_Ns_per_m' into its [contact]"));
  EXPECT_THAT(said("delay: more than 600 periods"),
              HasSubstr("not known: delay: more than 600 periods; correct 'delay_ms'"));
  EXPECT_THAT(said("what a release does: too slow to be simulated"), HasSubstr("make it stiffer"));
}

// The faults of a fake in their text form.

using Kind = Trouble::Kind;

std::string refused_fault(const std::string& text) {
  return test::refusal(ErrorKind::input, [&] { (void)fault_of(text, "--fault"); });
}

TEST(FaultText, IsADriverAFaultAValueATimeAndHowLong) {
  const Fault whole = fault_of("netft:loss=5%@2s+500ms", "");
  EXPECT_EQ(whole.driver, "netft");
  EXPECT_EQ(whole.trouble.kind, Kind::loss);
  EXPECT_DOUBLE_EQ(whole.trouble.value, 0.05);
  EXPECT_DOUBLE_EQ(whole.at, 2.0);
  EXPECT_DOUBLE_EQ(whole.lasts, 0.5);
  const Fault least = fault_of("gcs:stall", "");
  EXPECT_EQ(least.trouble.kind, Kind::stall);
  EXPECT_EQ(least.at, 0.0);
  EXPECT_TRUE(std::isnan(least.lasts));
  EXPECT_DOUBLE_EQ(fault_of("igtl:jitter=20ms", "").trouble.value, 0.020);
  EXPECT_DOUBLE_EQ(fault_of("gcs:error-code=504", "").trouble.value, 504.0);
  EXPECT_DOUBLE_EQ(fault_of("netft:error-code=0x90000000", "").trouble.value, 2415919104.0);
  EXPECT_DOUBLE_EQ(fault_of("netft:error-code=0XffFFffFF+1s", "").trouble.value, 4294967295.0);
  EXPECT_TRUE(std::isnan(fault_of("netft:error-code", "").trouble.value)) << "the device's own";
  EXPECT_DOUBLE_EQ(fault_of("gcs:slow-start=1.5s", "").trouble.value, 1.5);
  EXPECT_DOUBLE_EQ(fault_of("netft:garbage", "").trouble.value, 1.0);
}

TEST(FaultText, IsReadBackAsItWasWritten) {
  for (const char* text : {"loss=5%", "jitter=20ms", "reorder=30%", "duplicate=10%", "stall", "disconnect",
                           "garbage=1%", "half-message=1%", "saturate", "error-code=504", "error-code",
                           "error-code=0x90000000", "slow-start=2000ms"})
    EXPECT_EQ(text_of(fault_of(std::string("gcs:") + text, "").trouble), text);
}

TEST(FaultText, WhatIsNoneIsRefusedWithWhatWasExpected) {
  const std::map<std::string, std::vector<const char*>> refused{
      {"no driver is named", {"loss=5%", ":loss"}},
      {"no driver", {""}},
      {"there is no fault 'los'", {"netft:los=5%"}},
      {"there is no fault ''", {"netft:"}},
      {"'5' is no value of 'loss'", {"netft:loss=5"}},
      {"no value",
       {"netft:loss=101%", "netft:loss=150 %", "netft:loss=-1%", "netft:loss=nan%", "netft:loss=1e400%",
        "igtl:jitter=20", "igtl:jitter=20us", "igtl:jitter=2e6s", "gcs:error-code=1.5", "gcs:error-code=1e10",
        "gcs:error-code=-504", "gcs:error-code=", "netft:error-code=0x", "netft:error-code=0x1g",
        "netft:error-code=0x-1", "netft:error-code=0x100000000"}},
      {"'-20ms' is no value of 'jitter'", {"igtl:jitter=-20ms"}},
      {"'stall' has no value", {"gcs:stall=1"}},
      {"'3' is no time", {"gcs:stall@3"}},
      {"no time", {"gcs:stall@-3s", "gcs:stall@infs"}},
      {"no time to last", {"gcs:stall@3s+0s", "gcs:stall@3s+"}}};
  for (const auto& [why, texts] : refused)
    for (const char* text : texts) {
      SCOPED_TRACE(text);
      EXPECT_THAT(refused_fault(text), testing::HasSubstr(why));
      EXPECT_THAT(refused_fault(text), testing::HasSubstr("expected DRIVER:FAULT[=V][@TIME][+TIME]"));
      EXPECT_THAT(refused_fault(text), testing::Not(testing::HasSubstr("\n")));
    }
}

}  // namespace
}  // namespace enc::app
