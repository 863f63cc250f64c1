// Faults that somebody switches on change what the core reads, and end with their cause.
#include "trial/steered/faults.h"

#include <set>

#include <gtest/gtest.h>

namespace enc::trial {
namespace {

// A tracker with a new sample every 8 ticks of 1 ms, and a force sensor.
class SwitchedFaults : public testing::Test {
 protected:
  void tick() {
    if (ticks_ % 8 == 0) {
      in_.tool.t = Time{} + from_seconds(1e-3 * ticks_);
      in_.tool.health = Health::ok;
      in_.tool.value.tool = 0;
    }
    in_.wrench.value.force = {0.5, -7, 9};
    in_.wrench.health = Health::ok;
    ++ticks_;
    faults_.apply(in_);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  // Age of what the core is told, ms.
  [[nodiscard]] double age() const {
    return 1e3 * seconds(Time{} + from_seconds(1e-3 * (ticks_ - 1)) - in_.tool.t);
  }

  Faults faults_;
  Inputs in_;
  int ticks_ = 0;
};

TEST_F(SwitchedFaults, NothingHappensWithoutOne) {
  run(80);
  EXPECT_NEAR(age(), 7.0, 1e-6);
  EXPECT_EQ(in_.wrench.value.force.xyz, (std::array{0.5, -7.0, 9.0}));
}

TEST_F(SwitchedFaults, AFrozenTrackerRepeatsItsLastSample) {
  run(80);
  faults_.set(kFrozenTracker);
  run(200);
  EXPECT_NEAR(age(), 207.0, 1e-6);
  faults_.set(0);
  run(8);
  EXPECT_NEAR(age(), 7.0, 1e-6);
}

TEST_F(SwitchedFaults, ThreeOfFourPacketsAreLost) {
  faults_.set(kDroppedPackets);
  std::set<Time> told;
  for (int i = 0; i < 800; ++i) {
    tick();
    told.insert(in_.tool.t);
  }
  EXPECT_NEAR(static_cast<double>(told.size()), 25.0, 1.0) << "of 100";
}

TEST_F(SwitchedFaults, ALateClockStampsTooEarly) {
  run(80);
  faults_.set(kLateClock);
  run(80);
  EXPECT_NEAR(age(), 7.0 + 1e3 * Faults::kLate, 1e-6) << "once, not at each tick";
}

TEST_F(SwitchedFaults, ASaturatedSensorSaysSo) {
  faults_.set(kSaturated);
  tick();
  EXPECT_EQ(in_.wrench.value.force.xyz, (std::array{0.5, -Faults::kRange, Faults::kRange}));
  EXPECT_EQ(in_.wrench.health, Health::saturated);
  faults_.set(0);
  tick();
  EXPECT_EQ(in_.wrench.health, Health::ok);
}

}  // namespace
}  // namespace enc::trial
