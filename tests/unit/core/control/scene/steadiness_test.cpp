// Whether an object stands still under a hand, of the loop with its limits.
#include "core/control/scene/steadiness.h"

#include <gtest/gtest.h>

#include "core/control/scene/scene.h"
#include "core/spec/rig_spec.h"

namespace enc {
namespace {

Response limited_spring(double k, double limit) { return {{{k, 0, 0, 0}, {k, 0, 0, 0}, limit}, 0.0}; }

// The twin swings by 10 mm at 150 N/m under this hand, and stands still from 260 N/m on
// (docs/notes/stiffness.md).
TEST(Steadiness, ASoftSpringSwingsAndAFirmOneStandsStill) {
  const Steadiness loop{RigSpec{}};
  EXPECT_NEAR(loop.swing(limited_spring(150.0, 0.023), 0.0172, 0.023, 2.0), 10e-3, 2e-3);
  EXPECT_LT(loop.swing(limited_spring(400.0, 0.023), 0.015, 0.023, 2.0), 0.2e-3);
  EXPECT_GT(loop.worst(limited_spring(150.0, 0.023), 0.023, 2.0).swing, 5e-3);
  EXPECT_EQ(loop.worst(limited_spring(2000.0, 0.006), 0.006, 0.5).swing, 0.0);
  const double softest = loop.softest(0.015, 30.0, 2.0);
  EXPECT_GT(softest, 285.0);  // there the twin swings 6 mm deep, though not 15 mm
  EXPECT_LT(softest, 400.0);
}

// The twin swings by 13 mm at 450 N/m if it is pushed so quickly, and stands still from 600 N/m on.
TEST(Steadiness, AQuickPushNeedsAFirmerSpring) {
  const Steadiness loop{RigSpec{}};
  EXPECT_GT(loop.swing(limited_spring(450.0, 0.023), 0.015, 0.023, 0.5), 1e-3);
  EXPECT_LT(loop.swing(limited_spring(450.0, 0.023), 0.015, 0.023, 2.0), 0.2e-3);
  const double softest = loop.softest(0.015, 30.0, 0.5);
  EXPECT_GT(softest, 500.0);
  EXPECT_LT(softest, 750.0);
  EXPECT_GT(loop.worst(limited_spring(0.8 * softest, 0.0225), 0.0225, 0.5).swing, 0.0);
  EXPECT_EQ(loop.worst(limited_spring(1.05 * softest, 0.015), 0.015, 0.5).swing, 0.0);
}

TEST(Steadiness, WithoutTheAccelerationLimitItIsTheLinearBound) {
  RigSpec rig;
  rig.manipulator.acceleration = 1000.0;
  const double linear = lowest_stable_stiffness(loop_of(rig));
  EXPECT_NEAR(Steadiness(rig).softest(0.015, 30.0, 2.0), linear, 0.25 * linear);
  rig.manipulator.acceleration = 0.41;
  EXPECT_GT(Steadiness(rig).softest(0.015, 30.0, 2.0), 1.5 * linear);
}

TEST(Steadiness, TheObservedDamperHoldsWhatTheSpringAloneDoesNot) {
  RigSpec rig;
  rig.admittance.damping = Damping::observed;
  EXPECT_LT(Steadiness(rig).swing(limited_spring(150.0, 0.023), 0.0172, 0.023, 2.0), 1e-3);
}

TEST(Steadiness, AStifferHandNeedsAStifferObject) {
  RigSpec rig;
  double before = 0.0;
  for (const double hand : {40.0, 200.0, 700.0, 2000.0, 5000.0}) {
    rig.contact.hand_stiffness = hand;
    const double softest = Steadiness(rig).softest(0.015, 30.0, 2.0);
    EXPECT_GT(softest, before) << hand;
    before = softest;
  }
}

}  // namespace
}  // namespace enc
