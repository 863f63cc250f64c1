// Fault x device x mode: what the run comes to, and how soon after the fault was injected. In virtual time;
// the table of docs/reference/safety.md is this one.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hw_drivers/gcs/wire/error_text.h"
#include "tests/conformance/wired_trial.h"

namespace enc::test {
namespace {

struct Fault {
  const char *device, *name;
  std::function<void(WiredTrial&)> inject, cure;
  double hold;        // ms after it: held by then
  std::uint32_t why;  // among the reasons
  bool ends_link;     // until a new run
  bool goes_on;       // once it is cured
};

constexpr double kNever = std::numeric_limits<double>::infinity();

void nothing(WiredTrial&) {}

const std::vector<Fault>& faults() {
  static const std::vector<Fault> kFaults{
      {"manipulator", "silent", [](WiredTrial& w) { w.machine.silent = true; },
       [](WiredTrial& w) { w.machine.silent = false; }, 9, kTipLost, true, false},
      {"manipulator", "closed", [](WiredTrial& w) { w.machine.hung_up = true; },
       [](WiredTrial& w) { w.machine.hung_up = false; }, 2, kTipInvalid, true, false},
      {"manipulator", "garbage", [](WiredTrial& w) { w.machine.instead = "?\x7f what\n"; }, nothing, 6,
       kTipInvalid, true, false},
      {"manipulator", "half a message", [](WiredTrial& w) { w.machine.half = true; },
       [](WiredTrial& w) { w.machine.silent = false; }, 9, kTipLost, true, false},
      {"manipulator", "a strut fails", [](WiredTrial& w) { w.controller().fail(504); },
       [](WiredTrial& w) { static_cast<void>(w.controller().take("SVO X 1 Y 1 Z 1 U 1 V 1 W 1\n")); }, 6,
       kTipInvalid, true, false},
      {"manipulator", "stopped by another hand",
       [](WiredTrial& w) { static_cast<void>(w.controller().take("STP\n")); }, nothing, 6, kTipInvalid, true,
       false},
      {"force", "silent", [](WiredTrial& w) { w.force_silent = true; },
       [](WiredTrial& w) { w.force_silent = false; }, 6, kForceLost, true, false},
      {"force", "saturated", [](WiredTrial& w) { w.box().fail(0x80020000); },
       [](WiredTrial& w) { w.box().fail(0); }, 2, kForceSaturated, false, true},
      {"force", "reports an error", [](WiredTrial& w) { w.box().fail(0x90000000); },
       [](WiredTrial& w) { w.box().fail(0); }, 2, kForceInvalid, false, true},
      {"tracker", "silent", [](WiredTrial& w) { w.tracker_silent = true; },
       [](WiredTrial& w) { w.tracker_silent = false; }, 101, kToolLost, true, false},
  };
  return kFaults;
}

struct Reaction {
  double hold = kNever, rest = kNever;  // ms
  std::uint32_t why = 0;
  bool linked = true, goes_on = false;  // after it was cured
  double way = 0.0;                     // of the tip, from the hold on, m
  std::string end{};                    // why it holds at the end
};

Reaction react(const Fault& fault, double at) {
  WiredTrial wired(models::load(ENCOUNTER_SOURCE_DIR "/models/scenes/tennis_ball.toml", "fakes"), {});
  trial::Trial& trial = wired.trial();
  while (trial.now().t < Time(from_seconds(at))) wired.tick();
  EXPECT_NE(trial.outputs().mode, Mode::hold);
  fault.inject(wired);
  Reaction of;
  Vec3 first = Vec3::Zero();
  for (int i = 1; i <= 700; ++i) {
    wired.tick();
    const auto& plant = trial.world().machine->state();
    if (trial.outputs().mode == Mode::hold && std::isinf(of.hold)) {
      of.hold = i;
      of.why = trial.outputs().why;
      first = plant.pose.p();
    }
    const bool still = plant.velocity.norm() < 1e-4;
    if (!still) of.rest = kNever;
    if (still && std::isinf(of.rest)) of.rest = i;
    if (!std::isinf(of.hold)) of.way = std::max(of.way, (plant.pose.p() - first).norm());
  }
  fault.cure(wired);
  for (int i = 0; i < 500; ++i) {
    wired.tick();
    of.goes_on = of.goes_on || trial.outputs().mode != Mode::hold;
  }
  of.end = fmt::format("at the end: {}", why_text(trial.outputs().why));
  of.linked =
      trial.rig().manipulator->linked() && trial.rig().force->linked() && trial.rig().tracker->linked();
  return of;
}

// Within how long the machine stands: it brakes from 50 mm/s in 122 ms, after the fault was seen.
constexpr double kRest = 60.0;   // ms after the hold
constexpr double kWay = 0.2e-3;  // m

TEST(SafetyMatrix, EachFaultEndsInHoldWithTheMachineAtRest) {
  for (const auto& [mode, at] : {std::pair{"follow", 5.5}, {"contact", 10.0}})
    for (const Fault& fault : faults()) {
      SCOPED_TRACE(fmt::format("{} {}, in {}", fault.device, fault.name, mode));
      const Reaction of = react(fault, at);
      EXPECT_LE(of.hold, fault.hold);
      EXPECT_NE(of.why & fault.why, 0U) << why_text(of.why);
      EXPECT_LE(of.rest, fault.hold + kRest);
      EXPECT_LE(of.way, kWay);
      EXPECT_EQ(of.linked, !fault.ends_link);
      EXPECT_EQ(of.goes_on, fault.goes_on) << of.end;
      testing::Test::RecordProperty(
          fmt::format("{}, {}, {}", fault.device, fault.name, mode),
          fmt::format("hold {} ms, rest {} ms, {:.2f} mm", of.hold, of.rest, 1e3 * of.way));
    }
}

}  // namespace
}  // namespace enc::test
