// Records that are lost, late, doubled, old or ill; and what a box must be before a run begins.
#include "hw_drivers/netft/drive/session.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/netft/drive/inspect.h"
#include "hw_drivers/netft/fake/box.h"

namespace enc::netft {
namespace {

constexpr Duration ms(double n) { return from_seconds(1e-3 * n); }

Record record(std::uint32_t number, std::uint32_t sample, std::int32_t fx = 0, std::uint32_t status = 0) {
  return {number, sample, status, {fx, 0, 0, 0, 0, 0}};
}

struct Bench {
  Session session{gamma(), Duration{}, false};
  void take(const Record& one, double now_ms) { session.take(bytes_of(one), Time(ms(now_ms))); }
  [[nodiscard]] double fx() const { return session.newest().value.force.xyz[0]; }
};

TEST(NetftSession, SaysNothingBeforeTheFirstRecord) {
  const Bench bench;
  EXPECT_EQ(bench.session.newest().health, Health::absent);
}

TEST(NetftSession, CountsAreNewtonsAndNewtonMetres) {
  Bench bench;
  bench.session.take(bytes_of(Record{1, 7, 0, {1500000, -2000000, 12000000, 100000, -200000, 300000}}),
                     Time{});
  const Wrench& wrench = bench.session.newest().value;
  EXPECT_EQ(bench.session.newest().health, Health::ok);
  EXPECT_EQ(wrench.force.xyz, (std::array<double, 3>{1.5, -2.0, 12.0}));
  EXPECT_EQ(wrench.torque.xyz, (std::array<double, 3>{0.1, -0.2, 0.3}));
}

// A page in pounds and inches, as the box has them from an American factory: what comes out is SI.
TEST(NetftSession, CountsOfPoundsAndInchPoundsAreNewtonsAndNewtonMetres) {
  Configuration of;
  ASSERT_EQ(read_xml("<netft><prodname>Net F/T</prodname><cfgcpf>1000000</cfgcpf><cfgcpt>2000000</cfgcpt>"
                     "<scfgfu>lbf</scfgfu><scfgtu>lbf-in</scfgtu></netft>",
                     of),
            "");
  Session session(of, Duration{}, false);
  session.take(bytes_of(Record{1, 7, 0, {1000000, -2000000, 0, 2000000, -1000000, 0}}), Time{});
  const Wrench& wrench = session.newest().value;
  EXPECT_NEAR(wrench.force.xyz[0], 4.4482216152605, 1e-12);       // a pound
  EXPECT_NEAR(wrench.force.xyz[1], -2 * 4.4482216152605, 1e-12);  // two
  EXPECT_NEAR(wrench.torque.xyz[0], 0.1129848290276167, 1e-15);   // an inch pound
  EXPECT_NEAR(wrench.torque.xyz[1], -0.5 * 0.1129848290276167, 1e-15);
}

// The counter goes on by 6.986 each millisecond: 0.2 % less than what it is taken for.
TEST(NetftSession, MeasuresTheRateOfItsCounterInHalfAMinute) {
  Bench bench;
  const auto record_of = [](std::uint32_t n) { return record(n, n * 6986U / 1000U); };
  for (std::uint32_t n = 1; n < 29'000; ++n) bench.take(record_of(n), n);
  EXPECT_TRUE(std::isnan(bench.session.counted()));
  for (std::uint32_t n = 29'000; n < 40'000; ++n) bench.take(record_of(n), n);
  EXPECT_NEAR(bench.session.counted(), 6986.0, 1.0);
  // The box begins anew.
  for (std::uint32_t n = 1; n < 40'000; ++n) bench.take(record(n, 7 * n - 2'000'000'000U), 60'000 + n);
  EXPECT_NEAR(bench.session.counted(), 7000.0, 1.0);
}

TEST(NetftSession, OldAndDoubledRecordsChangeNothing) {
  Bench bench;
  bench.take(record(1, 70, 1), 10);
  bench.take(record(3, 84, 3), 12);
  bench.take(record(2, 77, 2), 12);
  bench.take(record(3, 84, 9), 12);
  EXPECT_EQ(bench.fx(), 3e-6);
  EXPECT_EQ(bench.session.counts().records, 2);
  EXPECT_EQ(bench.session.counts().missing, 1);
  EXPECT_EQ(bench.session.counts().old, 2);
  bench.session.take(std::vector<std::byte>(35), Time(ms(13)));
  EXPECT_EQ(bench.session.counts().wrong, 1);
}

// A record has no checksum.
TEST(NetftSession, NoiseOfTheRightLengthIsNoRecord) {
  Bench bench;
  for (std::uint32_t n = 1; n <= 50; ++n) bench.take(record(n, 7 * n, static_cast<std::int32_t>(n)), n);
  bench.take(record(0x9e3779b9, 0x7f4a7c15, 1'000'000'000), 51);
  bench.take(record(0x85ebca6b, 0xc2b2ae35, -1'000'000'000), 52);
  EXPECT_EQ(bench.fx(), 50e-6);
  EXPECT_EQ(bench.session.counts().wrong, 2);
  bench.take(record(53, 7 * 53, 53), 53);
  EXPECT_EQ(bench.fx(), 53e-6);
  EXPECT_EQ(bench.session.counts().missing, 2);
  EXPECT_EQ(bench.session.counts().old, 0);
}

TEST(NetftSession, ABoxThatBeganAnewIsBelievedFromItsSecondRecordOn) {
  Bench bench;
  for (std::uint32_t n = 1; n <= 50; ++n) bench.take(record(n, 100'000'000 + 7 * n, 1), n);
  bench.take(record(1, 7, 2), 1000);
  EXPECT_EQ(bench.fx(), 1e-6);
  bench.take(record(2, 14, 3), 1001);
  EXPECT_EQ(bench.fx(), 3e-6);
  bench.take(record(3, 21, 4), 1002);
  EXPECT_EQ(bench.fx(), 4e-6);
  EXPECT_LT(age(Time(ms(1002)), bench.session.newest().t), 0.002);
}

TEST(NetftSession, CountersGoRound) {
  Bench bench;
  bench.take(record(0xffffffff, 0xfffffffa, 1), 1);
  bench.take(record(1, 1, 2), 2);  // seven samples on
  EXPECT_EQ(bench.fx(), 2e-6);
  EXPECT_EQ(bench.session.newest().t, Time(ms(2)));
  bench.take(record(1, 0xfffffffb, 3), 3);
  EXPECT_EQ(bench.fx(), 2e-6);
}

// After a pause of the process the socket is full of what was true before it.
TEST(NetftSession, WhatWaitedInTheSocketIsAsOldAsItIs) {
  Bench bench;
  std::uint32_t n = 0;
  for (; n < 100; ++n) bench.take(record(n + 1, 7 * n), n);
  EXPECT_EQ(bench.session.newest().t, Time(ms(99)));
  for (const std::uint32_t until = n + 50; n < until; ++n) bench.take(record(n + 1, 7 * n), 2100);
  EXPECT_EQ(bench.session.newest().t, Time(ms(149))) << "came at 2,100";
  bench.take(record(2200, 7 * 2100), 2100);
  EXPECT_EQ(bench.session.newest().t, Time(ms(2100)));
}

TEST(NetftSession, AnyNetworkGivesTimesThatOnlyGrow) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<std::pair<double, std::uint32_t>> way;  // arrival in ms, number
    std::exponential_distribution<double> late(1.0);
    for (std::uint32_t n = 1; n <= 2000; ++n)
      if (random() % 20 != 0) way.emplace_back(n + 0.2 + late(random), n);
    std::sort(way.begin(), way.end());
    Bench bench;
    Time last{};
    double worst = 0.0;
    for (const auto& [arrives, n] : way) {
      bench.take(record(n, 7 * n, static_cast<std::int32_t>(n)), arrives);
      EXPECT_GE(bench.session.newest().t, last) << "seed " << seed;
      last = bench.session.newest().t;
      EXPECT_LE(last, Time(ms(arrives)));
      const double truly = 1e6 * bench.fx();  // ms
      if (n > 200) worst = std::max(worst, std::abs(1e3 * seconds(last.time_since_epoch()) - truly));
    }
    EXPECT_LT(worst, 0.35) << "ms; the way that nobody can know is 0.2. Seed " << seed;
  }
}

TEST(NetftSession, AStatusIsSaidAndRemembered) {
  Bench bench;
  bench.take(record(1, 7, 1, kError | kSaturated), 1);
  EXPECT_EQ(bench.session.newest().health, Health::saturated);
  bench.take(record(2, 14, 1, 0x90000000), 2);
  EXPECT_EQ(bench.session.newest().health, Health::fault);
  bench.take(record(3, 21, 1, 0), 3);
  EXPECT_EQ(bench.session.newest().health, Health::ok);
  EXPECT_EQ(bench.session.counts().status, 0x90000000U);
}

// cfgmr of a Gamma: 130 N across, 400 N along z, 10 N m about each axis.
TEST(NetftSession, AForceBeyondTheRatingOfItsAxisIsSaturated) {
  const auto health = [](std::array<std::int32_t, 6> counts, std::uint32_t status = 0) {
    Bench bench;
    bench.session.take(bytes_of(Record{1, 7, status, counts}), Time(ms(1)));
    EXPECT_EQ(bench.session.counts().beyond, bench.session.newest().health == Health::ok ? 0 : 1);
    return bench.session.newest().health;
  };
  EXPECT_EQ(health({129'999'999, -130'000'000, 399'999'999, 0, 0, -10'000'000}), Health::ok);
  EXPECT_EQ(health({130'000'001, 0, 0, 0, 0, 0}), Health::saturated);
  EXPECT_EQ(health({0, 0, -400'000'001, 0, 0, 0}), Health::saturated);
  EXPECT_EQ(health({0, 0, 0, 0, 0, 10'000'001}), Health::saturated);
  EXPECT_EQ(health({130'000'001, 0, 0, 0, 0, 0}, 0x90000000), Health::fault) << "a fault stays one";
}

std::string refused(const Configuration& of, const NetftSettings& settings = {}) {
  try {
    static_cast<void>(inspect(xml_of(of), settings, Duration(1'000'000)));
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::device);
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  return "";
}

TEST(NetftInspect, WhatIsNotAsItMustBeIsRefusedWithAWayOut) {
  EXPECT_EQ(refused(gamma()), "");
  Configuration other = gamma();
  other.product = "Ethernet Axia";
  EXPECT_THAT(refused(other),
              testing::HasSubstr("is another device: it says 'Ethernet Axia', expected 'F/T'"));
  Configuration slow = gamma();
  slow.rate = 500;
  EXPECT_THAT(
      refused(slow),
      testing::HasSubstr("sends 500 records a second, and the loop makes 1000; set the RDT output rate"));
  slow.rate = kUnset;
  EXPECT_THAT(refused(slow), testing::HasSubstr("sends nan records"));
  Configuration off = gamma();
  off.streams = false;
  EXPECT_THAT(refused(off), testing::HasSubstr("RDT is switched off; enable it"));
  Configuration weak = gamma();
  weak.ratings[2] = 65;
  EXPECT_THAT(
      refused(weak),
      testing::HasSubstr("can do less than the rig file promises: Fz to 65 of 130 N; choose another"));
  weak.ratings[2] = kUnset;
  EXPECT_THAT(refused(weak), testing::HasSubstr("Fz to nan of 130 N"));
  NetftSettings settings;
  settings.torque_range = 20;
  EXPECT_THAT(refused(gamma(), settings),
              testing::HasSubstr("Tx to 10 of 20 N m; choose another configuration on its page, or lower "
                                 "driver.netft.torque_range_Nm"));
  try {
    static_cast<void>(inspect("<html>\n</html>", {}, Duration(1'000'000)));
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(),
                testing::HasSubstr("its netftapi2.xml has no <prodname>; see that it is a Net F/T"));
  }
}

}  // namespace
}  // namespace enc::netft
