// Parts of the machine that obstruct a tool, and the places that the tip reaches, computed by hand.
#include "core/control/scene/press_check.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "benchmarks/workspace/reach_volume.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

Vec<'W'> from(double polar) { return {std::sin(polar * kDegree), 0.0, std::cos(polar * kDegree)}; }

// Tips of 5 and 2 mm radius stand 7 mm apart. Below the tip, the tool's centre must be 4 + 2 mm off the
// stem's axis: asin(6 / 7) = 58.997 degrees off straight up.
TEST(PressCheck, TheStemBeginsWhereItMust) {
  const Scene scene = prepare(test::ball_scene(), {});
  const Tool tool = scene.tools.front();
  EXPECT_NEAR(steepest_press(scene, tool) / kDegree, 180.0 - std::asin(6.0 / 7.0) / kDegree, 1e-6);
  EXPECT_EQ(in_the_way(scene, from(0), tool), Obstacle::none);
  EXPECT_EQ(in_the_way(scene, from(90), tool), Obstacle::none);
  EXPECT_EQ(in_the_way(scene, from(120.9), tool), Obstacle::none);
  EXPECT_EQ(in_the_way(scene, from(121.1), tool), Obstacle::stem);
  EXPECT_EQ(in_the_way(scene, from(180), tool), Obstacle::stem);
}

// Without a stem the gripper's edge, 37.7 mm beside and 40 mm below H, is 2 mm off a line at
// atan(37.7 / 40) + asin(2 / 54.97) = 45.39 degrees off straight down.
TEST(PressCheck, ThenTheGripper) {
  RigSpec rig;
  rig.manipulator.stem_radius = 0.0;
  const Scene scene = prepare(test::ball_scene(), rig);
  const double edge = std::atan2(37.7, 40.0) + std::asin(2.0 / std::hypot(37.7, 40.0));
  Tool tool = scene.tools.front();
  tool.length = 0.120;
  EXPECT_NEAR(steepest_press(scene, tool) / kDegree, 180.0 - edge / kDegree, 1e-6);
  EXPECT_EQ(in_the_way(scene, from(150), tool), Obstacle::gripper);
  tool.length = 0.010;  // the tool ends above the gripper
  EXPECT_EQ(in_the_way(scene, from(150), tool), Obstacle::none);
}

TEST(PressCheck, APressFromBelowIsRefusedEvenWithinReach) {
  SceneSpec spec = test::ball_scene();
  spec.objects[0].position.z() = 0.015;  // its lower side is within reach, its top is beyond
  spec.user.emplace();
  spec.user->polar = 110.0 * kDegree;
  EXPECT_NO_THROW((void)prepare(spec, {}));
  spec.user->polar = 150.0 * kDegree;
  try {
    (void)prepare(spec, {});
    ADD_FAILURE() << "accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.key(), "user.polar");
    EXPECT_NE(std::string(e.what()).find("its stem is in the tool's way; press at most 121 degrees"),
              std::string::npos)
        << e.what();
  }
}

// All struts have equal lengths at the zero, so the travel up and down is sqrt((L +- stroke)^2 - r^2) - h.
TEST(ReachVolume, TheMiddleColumnByHand) {
  const Hexapod machine{HexapodGeometry{}};
  const bench::workspace::ReachVolume reach(machine);
  const HexapodGeometry g;
  const double beside2 = machine.zero_length() * machine.zero_length() - g.height * g.height;
  const auto at = [&](double length) { return std::sqrt(length * length - beside2) - g.height; };
  const auto column = reach.column(0.0, 0.0);
  EXPECT_NEAR(column.high, at(machine.zero_length() + g.stroke), 1e-12);
  EXPECT_NEAR(column.low, at(machine.zero_length() - g.stroke), 1e-12);
}

// Column and limit() compute the same answer in two ways.
TEST(ReachVolume, AgreesWithTheMachinesOwnLimit) {
  const Hexapod machine{HexapodGeometry{}};
  const bench::workspace::ReachVolume reach(machine);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto part = [&](int prime) {
      return std::fmod(i * std::sqrt(static_cast<double>(prime)), 1.0) - 0.5;
    };
    const Vec3 p(0.2 * part(2), 0.2 * part(3), 0.08 * part(5));
    const auto column = reach.column(p.x(), p.y());
    const bool reached =
        machine.limit(Pose<'R', 'H'>(Quat::Identity(), Vec3(p + machine.zero().p()))) == ReachLimit::none;
    EXPECT_EQ(p.z() >= column.low && p.z() <= column.high, reached) << p.transpose();
    if (reached) {
      EXPECT_GE(reach.turned_slack(p), 0.0);
    }
    inside += reached;
  }
  // 0.29e-3 of 0.2 x 0.2 x 0.08 m3.
  EXPECT_NEAR(inside / 20000.0 * 0.2 * 0.2 * 0.08, reach.straight(1e-3), 0.02e-3);
}

// A machine twice as large in all lengths has eight times the volume.
TEST(ReachVolume, GrowsAsTheCube) {
  HexapodGeometry half;
  for (double* x : {&half.base_radius, &half.platform_radius, &half.height, &half.tip_height, &half.stroke})
    *x *= 0.5;
  const bench::workspace::ReachVolume whole{Hexapod(HexapodGeometry{})};
  EXPECT_NEAR(8.0 * bench::workspace::ReachVolume{Hexapod(half)}.straight(0.5e-3), whole.straight(1e-3),
              1e-9);
  const auto small = bench::workspace::ReachVolume{Hexapod(half)}.extents(), big = whole.extents();
  EXPECT_LT((2.0 * small.high - big.high).norm(), 0.5e-3);
}

}  // namespace
}  // namespace enc
