// step() driven by hand: what is felt, and what a force moves.
#include <gtest/gtest.h>

#include "core/control/step.h"
#include "tests/support/by_hand.h"

namespace enc {
namespace {

using test::expect_within_limits;
using test::kBallRadius;
using test::kSkin;
using test::kTipRadius;
using test::kToolRadius;
using test::kTop;
using test::Loop;
using test::make;
using test::wait_under;

TEST(Force, ZeroErrorAndWeightAreTaredAway) {
  Loop loop = make(test::ball_scene());
  loop.force_zero = Vec<'F'>(0.7, -0.4, 1.3);
  loop.tool_tip = Point<'W'>(0, 0, kTop + 0.012);
  for (int i = 0; i < 199; ++i) EXPECT_TRUE(loop.tick().why & kTaring) << i;  // tare_time is 0.2 s
  loop.tick(2);
  EXPECT_FALSE(loop.out.why & kTaring);
  loop.tick(1000);
  EXPECT_LT(loop.out.force.norm(), 1e-9);
}

// [issue 3] "a rotated sensor and an oblique force give the exact displacement to 1e-9".
void oblique(Tangential tangential) {
  BehaviourSpec behaviour = test::spring();
  behaviour.tangential = tangential;
  behaviour.tangential_stiffness = 4000.0;
  RigSpec rig = test::exact_rig();
  rig.frames.H_F = {{0.004, -0.003, -0.127}, {0.3, -0.7, 2.1}};
  rig.force.tare = Tare::start;
  Loop loop = make(test::ball_scene(behaviour), rig);
  loop.force_zero = Vec<'F'>(0.7, -0.4, 1.3);
  loop.tool_tip = Point<'W'>(0.006, 0.004, 0.030);
  loop.tick(1500);
  // Touch there, where the normal is oblique in W as well.
  const Vec3 centre(0, 0, kTop - kBallRadius);
  const Vec3 n = (loop.tool_tip.e() - centre).normalized();
  loop.tool_tip = Point<'W'>(Vec3(centre + (kBallRadius + kToolRadius - 1e-4) * n));
  loop.tick();
  ASSERT_EQ(loop.out.mode, Mode::contact);
  const Vec3 side = n.unitOrthogonal();
  loop.force = Vec<'W'>(Vec3(-3.05 * n + 1.2 * side));
  loop.tick(4000);
  // Normal: (3.05 - 0.05) / 2000 = 1.5 mm inwards. Sideways: 1.2 / 4000 = 0.3 mm with the force, or nothing.
  const double sideways = tangential == Tangential::spring ? 0.3e-3 : 0.0;
  const Vec3 expected = centre + (kBallRadius - kTipRadius - kSkin - 1.5e-3) * n + sideways * side;
  EXPECT_LT((loop.tip().e() - expected).norm(), 1e-9);
  EXPECT_NEAR(loop.out.force.norm(), std::hypot(3.05, 1.2), 1e-9);
  expect_within_limits(loop);
}
TEST(Force, ObliqueOnATurnedSensorGivesTheExactDisplacementForStick) { oblique(Tangential::stick); }
TEST(Force, ObliqueOnATurnedSensorGivesTheExactDisplacementForSpring) { oblique(Tangential::spring); }

TEST(Force, InertiaOfWhatMovesIsNoContact) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.020);
  double felt = 0.0;
  for (int i = 0; i < 3000;
       ++i) {  // the tip is driven to and fro at its limits; 0.91 kg * 0.41 m/s^2 = 0.37 N
    const double a = i % 1000 < 500 ? 0.4 : -0.4;
    loop.tool_tip = Point<'W'>(0.06 * std::sin(a), 0, kTop - kBallRadius + 0.06 * std::cos(a));
    felt = std::max(felt, loop.tick().force.norm());
  }
  EXPECT_LT(felt, 1e-6);
  EXPECT_GT(loop.worst_acceleration, 0.9);
}

}  // namespace
}  // namespace enc
