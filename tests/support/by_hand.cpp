#include "tests/support/by_hand.h"

#include <gtest/gtest.h>

#include "core/shape/deformation/dent.h"

namespace enc::test {
Loop make(const SceneSpec& spec, const RigSpec& rig) { return Loop(prepare(spec, rig)); }

SceneSpec with_display() {
  SceneSpec spec = ball_scene();
  spec.display.emplace();
  return spec;
}

void wait_under(Loop& loop, double gap) {
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.020);  // clear of the object, for the tare
  loop.tick(500);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + gap);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::follow) << why_text(loop.out.why);
}

void to_contact(Loop& loop) {
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -4.05);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::contact) << why_text(loop.out.why);
}

void draw(Inputs& in, const Loop& loop) {
  const Object& ball = loop.scene.objects[0];
  in.dent = {dent_of(ball.surface, 0, {ball.X_WO.inverse() * loop.tool_tip, kToolRadius}),
             loop.now() - Duration(20'000'000), Health::ok};
  if (in.dent.t < Time{}) in.dent.health = Health::absent;
}

void expect_within_limits(const Loop& loop) {
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  EXPECT_TRUE(loop.always_reachable);
}

}  // namespace enc::test
