// Every Gripper; so far the simulated one.
#include <gtest/gtest.h>

#include "tests/conformance/bench_world.h"

namespace enc::test {
namespace {

struct Gripping : testing::Test {
  Twin twin{{}, 1, "clamped_tool"};
  Gripper& device() { return *twin.rig.gripper; }
  Stamped<GripSample> after(const Grip& grip, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      twin.rig.clock->next();
      device().command(grip);
    }
    return device().read({});
  }
};

TEST_F(Gripping, IsAbsentBeforeTheFirstTickAndThenStampedAtEach) {
  EXPECT_EQ(device().read({}).health, Health::absent);
  for (int i = 0; i < 50; ++i) {
    const Tick k = twin.rig.clock->next();
    EXPECT_EQ(device().read({}).t, k.t);
    EXPECT_EQ(device().read({}).health, Health::ok);
    device().command({false, kUnset});
  }
}

TEST_F(Gripping, ClosesHoldsOpensAndSaysSo) {
  const auto closed = after({true, 100.0}, 400);
  EXPECT_EQ(closed.value.phase, GripPhase::closed);
  EXPECT_TRUE(closed.value.holding);
  EXPECT_DOUBLE_EQ(closed.value.force, 100.0);
  const auto open = after({false, kUnset}, 400);
  EXPECT_EQ(open.value.phase, GripPhase::open);
  EXPECT_FALSE(open.value.holding);
  EXPECT_EQ(open.value.force, 0.0);
  EXPECT_GT(open.value.opening, closed.value.opening);
}

TEST_F(Gripping, AForceOutsideItsRangeIsClampedAndSaid) {
  auto s = after({true, 1000.0}, 400);
  EXPECT_EQ(s.health, Health::out_of_range);
  EXPECT_DOUBLE_EQ(s.value.force, 215.0);
  s = after({true, 1.0}, 2);
  EXPECT_EQ(s.health, Health::out_of_range);
  EXPECT_DOUBLE_EQ(s.value.force, 54.0);
  EXPECT_EQ(after({true, 100.0}, 2).health, Health::ok);
}

TEST_F(Gripping, NotANumberIsRefusedAndTheGripKept) {
  after({true, 100.0}, 400);
  const auto s = after({true, kUnset}, 10);
  EXPECT_EQ(s.health, Health::fault);
  EXPECT_TRUE(s.value.holding);
  EXPECT_DOUBLE_EQ(s.value.force, 100.0);
  EXPECT_EQ(after({true, 100.0}, 2).health, Health::ok);
}

TEST_F(Gripping, StopKeepsWhatItHolds) {
  after({true, 100.0}, 400);
  for (int times = 0; times < 2; ++times) {
    device().stop();
    for (int i = 0; i < 300; ++i) twin.rig.clock->next();
    EXPECT_TRUE(device().read({}).value.holding);
    EXPECT_DOUBLE_EQ(device().read({}).value.force, 100.0);
  }
  EXPECT_FALSE(after({false, kUnset}, 400).value.holding);
}

TEST_F(Gripping, ReadingChangesNothing) {
  after({true, 100.0}, 30);
  const double opening = device().read({}).value.opening;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(device().read({}).value.opening, opening);
}

}  // namespace
}  // namespace enc::test
