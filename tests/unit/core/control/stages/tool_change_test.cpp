// A hand changes its tool [VHMR 3.2, 3.3]: the overlay follows at once, nothing is felt of it. And a contact
// that was expected too early is still one contact.
#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace enc::test {
namespace {

constexpr double kOtherRadius = 0.004;  // m

Scene two_tools(const RigSpec& rig) {
  SceneSpec spec = ball_scene();
  ToolSpec other = spec.tools.front();
  other.name = "probe";
  other.tip = Vec3(0, 0, -0.135);
  other.tip_radius = kOtherRadius;
  spec.tools.push_back(other);
  return prepare(spec, rig);
}

// Tool 0 over the ball's top, with its tip's surface `gap` above the ball, until the tip waits under it.
void hover(Loop& loop, double gap) {
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + gap);
  loop.tick(1500);
}

// Presses with 3 N until all has settled.
void press(Loop& loop) {
  hover(loop, 0.005);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.001);
  loop.force = Vec<'W'>(0, 0, -3.0);
  loop.tick(1500);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  ASSERT_GT(loop.out.deflection, 1e-3);
}

TEST(ToolChange, TheOverlayAndTheRadiusAreThoseOfTheToolInView) {
  for (const Prediction prediction :
       {Prediction::hold, Prediction::constant_velocity, Prediction::constant_acceleration}) {
    RigSpec rig;
    rig.tracker.prediction = prediction;
    Loop loop(two_tools(rig));
    hover(loop, 0.050);
    EXPECT_EQ(loop.out.view.tool, 0);
    EXPECT_NEAR(loop.out.gap, 0.050, 1e-6);
    loop.tool = 1;
    loop.tick();
    EXPECT_EQ(loop.out.view.tool, 1);
    EXPECT_NEAR(loop.out.gap, 0.050 + kToolRadius - kOtherRadius, 1e-6);
    EXPECT_EQ(loop.out.mode, Mode::follow);
  }
}

// The first tool was fast; of the second nothing is known but where it is.
TEST(ToolChange, PredictionStartsAnew) {
  Loop loop(two_tools(RigSpec{}));
  hover(loop, 0.060);
  for (int i = 0; i < 100; ++i) {
    loop.tool_tip = loop.tool_tip + Vec<'W'>(0.0002, 0, 0);
    loop.tick();
  }
  EXPECT_NEAR(loop.state.tip_motion.velocity.norm(), 0.2, 0.01);
  loop.tool = 1;
  loop.tick();
  EXPECT_EQ(loop.state.tip_motion.tool, 1);
  EXPECT_EQ(loop.state.tip_motion.velocity.norm(), 0.0);
  EXPECT_LT((loop.out.view.tip - loop.tool_tip).norm(), 1e-9);
}

TEST(ToolChange, ANewToolCloseToTheSurfaceIsNoContact) {
  Loop loop(two_tools(exact_rig()));
  hover(loop, 0.080);
  loop.tool = 1;
  loop.tool_tip =
      Point<'W'>(0.010, 0, kTop + kOtherRadius + 0.0005);  // beside the top: a little farther down
  loop.tick(300);
  EXPECT_EQ(loop.out.view.tool, 1);
  EXPECT_EQ(loop.out.contacts, 0);
  EXPECT_EQ(loop.out.deflection, 0.0);
  EXPECT_LT(loop.worst_outside, 0.0);
}

// The tracker takes the pressing tool for the other one, whose tip would be 30 mm higher or 15 mm deeper.
void swap_while_pressing(double leap) {
  Loop loop(two_tools(exact_rig()));
  press(loop);
  const double before = loop.out.deflection;
  loop.tool = 1;
  loop.tool_tip = loop.tool_tip + Vec<'W'>(0, 0, leap);
  loop.tick();
  EXPECT_EQ(loop.out.view.tool, 1);
  loop.tick(2000);
  EXPECT_EQ(loop.out.mode, Mode::contact) << why_text(loop.out.why);
  EXPECT_EQ(loop.out.contacts, 1);
  EXPECT_NEAR(loop.out.deflection, before, 1e-6);  // 2 N/mm: 0.002 N
  loop.force = Vec<'W'>(0, 0, 0);
  loop.tool_tip = Point<'W'>(0, 0, kTop + 0.020);
  loop.tick(2000);
  EXPECT_EQ(loop.out.mode, Mode::follow) << mode_name(loop.out.mode);
  EXPECT_EQ(loop.out.contacts, 1);
}
TEST(ToolChange, MistakenHigherWhilePressingMovesNothing) { swap_while_pressing(0.030); }
TEST(ToolChange, MistakenDeeperWhilePressingMovesNothing) { swap_while_pressing(-0.015); }

TEST(EarlyContact, IsKeptUntilTheToolComes) {
  Loop loop(two_tools(exact_rig()));
  hover(loop, 0.005);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0001);  // predicted too far
  loop.tick(5);
  EXPECT_EQ(loop.out.mode, Mode::contact);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.003);  // where it really is
  loop.tick(200);
  EXPECT_EQ(loop.out.mode, Mode::contact);
  loop.force = Vec<'W'>(0, 0, -1.0);
  loop.tick(200);
  EXPECT_EQ(loop.out.contacts, 1);
}

TEST(EarlyContact, EndsWhereTheToolTurnsBack) {
  Loop loop(two_tools(exact_rig()));
  hover(loop, 0.005);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0001);
  loop.tick(5);
  EXPECT_EQ(loop.out.mode, Mode::contact);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.012);
  loop.tick(500);
  EXPECT_EQ(loop.out.mode, Mode::follow);
}

}  // namespace
}  // namespace enc::test
