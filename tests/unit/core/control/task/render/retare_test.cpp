// Re-tare by windows: the zero follows the sensor while nothing touches, and nothing of a touch gets into it.
#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace enc {
namespace {

test::Loop loop_of(Tare tare) {
  RigSpec rig;
  rig.force.tare = tare;
  SceneSpec spec = test::plane_scene();
  spec.tracker.reset();
  spec.tools.clear();
  return test::Loop(prepare(spec, rig));
}

TEST(Retare, FollowsAZeroWithinThreeWindows) {
  test::Loop loop = loop_of(Tare::window);
  loop.tick(1000);
  loop.force_zero = Vec<'F'>(0, 0, -0.05);
  loop.tick(600);  // the window of the change, a whole one, and one in which that one waits
  EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.xyz[2], -0.05, 1e-9);
  test::Loop once = loop_of(Tare::start);
  once.tick(1000);
  once.force_zero = Vec<'F'>(0, 0, -0.05);
  once.tick(600);
  EXPECT_NEAR(recall<Commanded>(once.state).force_zero.xyz[2], 0.0, 1e-9);
}

// A touch that rises to the 0.1 N of a contact within 0.2 s: less than a window.
TEST(Retare, KeepsASlowTouchOutOfTheZero) {
  test::Loop loop = loop_of(Tare::window);
  loop.tick(1130);
  for (int i = 0; i < 500 && loop.out.mode != Mode::contact; ++i) {
    loop.force = Vec<'W'>(0, 0, -0.5e-3 * i);
    loop.tick();
  }
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.tick(500);
  EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.xyz[2], 0.0, 1e-12);
}

}  // namespace
}  // namespace enc
