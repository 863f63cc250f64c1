// The last word before a machine that takes positions: whoever is at the edge of the reach comes back.
#include "core/control/stages/guard.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::Loop;

// A ball on a floor. The reach is not convex: from many places at its edge the straight way to the ball leads
// out of it.
Loop ball_on_a_floor() {
  SceneSpec scene = test::ball_scene();
  scene.objects.front().radius = 0.012;
  scene.objects.front().position = {0, 0, 0.001};
  SceneSpec floor = test::plane_scene();
  floor.objects.front().name = "floor";
  floor.objects.front().position = {0, 0, -0.008};
  scene.objects.push_back(floor.objects.front());
  return Loop(prepare(scene, test::exact_rig()));
}

TEST(Guard, ATipAtTheEdgeOfTheReachComesBack) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> turn(0.0, 2.0 * M_PI), far(0.06, 0.2), high(0.0, 0.06);
  for (int seed = 0; seed < 60; ++seed) {
    Loop loop = ball_on_a_floor();
    const double a = turn(random), r = far(random);
    loop.tool_tip = Point<'W'>(0, 0, 0.05);
    loop.tick(500);
    const Point<'W'> aside(r * std::cos(a), r * std::sin(a), high(random));
    for (int i = 1; i <= 500; ++i) {  // slower than what is taken for a leap
      loop.tool_tip = Point<'W'>(0, 0, 0.05) + (i / 500.0) * (aside - Point<'W'>(0, 0, 0.05));
      loop.tick();
    }
    loop.tick(2500);
    const double out = (loop.tip() - Point<'W'>(0, 0, 0.008)).norm();
    for (int i = 1; i <= 500; ++i) {
      loop.tool_tip = aside + (i / 500.0) * (Point<'W'>(0, 0, 0.05) - aside);
      loop.tick();
    }
    loop.tick(4000);
    EXPECT_GT(out, 0.02) << seed;
    EXPECT_LT((loop.tip() - Point<'W'>(0, 0, 0.008)).norm(), 2e-3)
        << "went to " << aside.xyz[0] << " " << aside.xyz[1] << " " << aside.xyz[2];
    EXPECT_TRUE(loop.always_reachable);
    EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
    EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  }
}

// At the machine's greatest speed rounding is no reason to brake: the tip goes on evenly, whichever way the
// target goes.
TEST(Guard, AtItsGreatestSpeedTheTipDoesNotStutter) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> turn(0.0, 2.0 * M_PI), up(-0.2, 0.4);
  int seen = 0;
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Loop loop(prepare(test::plane_scene(), test::exact_rig()));
    loop.tool_tip = Point<'W'>(0, 0, 0.08);
    loop.tick(1000);
    const double a = turn(random);
    const Vec3 step =
        0.08e-3 * Vec3(std::cos(a), std::sin(a), up(random)).normalized();  // 80 mm/s, and the tip 50
    const double most = loop.scene.reach.speed;
    double before = 0.0;
    for (int i = 0; i < 400; ++i) {
      loop.tool_tip = Point<'W'>(Vec3(loop.tool_tip.e() + step));
      loop.tick();
      const double speed = recall<Commanded>(loop.state).command_velocity.norm();
      if (before > most * (1.0 - 1e-6)) {
        ++seen;
        ASSERT_GT(speed, most * (1.0 - 1e-6)) << i;
      }
      before = speed;
    }
    EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
    EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  }
  EXPECT_GT(seen, 1000);
}

}  // namespace
}  // namespace enc
