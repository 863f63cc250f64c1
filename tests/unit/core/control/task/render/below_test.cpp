// A tip that comes late, to a tool that is inside already.
#include <gtest/gtest.h>

#include "tests/support/by_hand.h"

namespace enc {
namespace {

using test::kTipRadius;
using test::kToolRadius;
using test::kTop;
using test::Loop;

Point<'W'> at(double x, double gap) { return {x, 0, kTop + kToolRadius + gap}; }

// The tip waits 30 mm beside the place where the tool is seen next, this deep inside. Least distance of the
// two surfaces on the way until the tip is under it.
double least_clearance(Loop& loop, double depth) {
  loop.tool_tip = at(0.030, 0.02);
  loop.tick(1500);
  loop.tool_tip = at(0.0, -depth);
  double least = 1.0;
  for (int i = 0; i < 1500; ++i) {
    loop.tick();
    EXPECT_EQ(loop.out.mode, Mode::contact) << i;
    if (std::abs(loop.tip().xyz[0]) < 0.6e-3) break;
    least = std::min(least, (loop.tip() - loop.tool_tip).norm() - kTipRadius - kToolRadius);
  }
  return least;
}

TEST(Below, ATipThatIsLateMeetsItsToolFromBelowAndNotFromTheSide) {
  for (const double depth : {1e-4, 1e-3, 4e-3, 8e-3}) {  // the object gives way by 6 mm
    Loop loop(prepare(test::plane_scene(), test::exact_rig()));
    EXPECT_GT(least_clearance(loop, depth), 1e-3) << depth;
    EXPECT_EQ(loop.out.deflection, 0.0) << "nothing has pressed the object";
    loop.tick(1000);
    EXPECT_NEAR(loop.tip().xyz[0], 0.0, 1e-6);
    EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius, 1e-5) << "up, as nothing pushes it down";
    EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-6);
    EXPECT_TRUE(loop.always_reachable);
  }
}

// One that is felt on the way is there: its object answers at once, where the tool is.
TEST(Below, EndsWhereForceIsFelt) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
  loop.tool_tip = at(0.030, 0.02);
  loop.tick(1500);
  loop.tool_tip = at(0.0, -4e-3);
  loop.tick(400);
  ASSERT_LT(loop.tip().xyz[2], kTop - kTipRadius - 5e-3);
  loop.force = Vec<'W'>(0, 0, -2.0);
  loop.tick(1000);
  EXPECT_NEAR(loop.out.deflection, 1e-3, 0.05e-3);  // 2 N, 2 N/mm, less the threshold
  EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius - loop.out.deflection, 1e-5);
}

// A touch that misses the middle of the tip is none that is late.
TEST(Below, IsNotWhereTheTwoCanMeet) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
  loop.tool_tip = at(0.0, 0.02);
  loop.tick(1500);
  loop.tool_tip = at(0.006, -1e-4);
  loop.tick(100);
  EXPECT_EQ(loop.out.mode, Mode::contact);
  EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius, 1e-5);
}

}  // namespace
}  // namespace enc
