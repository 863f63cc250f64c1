// The surface point under the tool: objects, meshes, the start of the search, jumps; and a change of tool.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "core/devices/mode.h"
#include "models/shapes/shapes.h"
#include "tests/support/scenes.h"

namespace enc::test {
namespace {

using test::Loop;

ObjectSpec mesh_object(const std::string& name, Mesh mesh, const Vec3& position) {
  ObjectSpec object;
  object.name = name;
  object.shape = ShapeKind::mesh;
  object.surface = std::make_shared<const Mesh>(std::move(mesh));
  object.position = position;
  object.behaviour = test::spring().name;
  return object;
}

// A row of small balls of triangles, their tops 7 mm above W's origin.
SceneSpec balls(int count) {
  SceneSpec spec = test::ball_scene();
  spec.objects.clear();
  for (int i = 0; i < count; ++i)
    spec.objects.push_back(mesh_object("ball_" + std::to_string(i), models::geodesic_ball(8, 0.012),
                                       {-0.04 + 0.025 * i, 0, -0.005}));
  return spec;
}

Loop loop_over(const SceneSpec& spec) { return Loop(prepare(spec, RigSpec{})); }

// A path over all objects, with presses in between.
Point<'W'> along(int k) {
  const double t = 1e-3 * k;
  return {0.1 * std::sin(0.9 * t), 0.02 * std::sin(2.3 * t), 0.020 + 0.015 * std::cos(3.1 * t)};
}

TEST(Touch, WhereTheSearchBeginsChangesNothing) {
  Loop warm = loop_over(balls(3));
  Loop cold = loop_over(balls(3));
  for (int k = 0; k < 4000; ++k) {
    warm.tool_tip = cold.tool_tip = along(k);
    cold.state.hints = Hints{};
    if (k % 3 == 0) cold.state.hints.tool[0] = {2, 100 + k % 500};  // or the search begins somewhere else
    warm.tick();
    cold.tick();
    ASSERT_EQ(warm.out.gap, cold.out.gap) << k;
    ASSERT_EQ(warm.out.object, cold.out.object) << k;
    ASSERT_EQ(warm.out.manipulator.tip.xyz, cold.out.manipulator.tip.xyz) << k;
  }
  EXPECT_GE(warm.state.hints.tool[0].feature, 0);
}

// The search takes the nearest of all objects: the result equals a query of each by hand.
TEST(Touch, ObjectsThatAreNotAskedCouldNotBeNearest) {
  Loop loop = loop_over(balls(5));
  for (int k = 0; k < 3000; ++k) {
    loop.tool_tip = along(k);
    const std::int32_t before = loop.state.object;
    const bool free = loop.state.mode == Mode::away || loop.state.mode == Mode::follow;
    loop.tick();
    if (!free) continue;
    std::int32_t nearest = -1;
    double least = INFINITY;
    for (std::size_t i = 0; i < loop.scene.objects.size(); ++i) {
      const Object& object = loop.scene.objects[i];
      const auto index = static_cast<std::int32_t>(i);
      const double d = object.surface.nearest(object.X_WO.inverse() * loop.tool_tip).distance -
                       (index == before ? 1e-3 : 0.0);  // the previous object is favoured by 1 mm
      if (d < least) nearest = index;
      least = std::min(least, d);
    }
    ASSERT_EQ(loop.out.object, nearest) << k;
  }
}

// Inside a cube of 50 mm the middle plane is equally near to the left and to the right face.
TEST(Touch, AJumpOfTheNearestPointIsTold) {
  SceneSpec spec = test::ball_scene();
  const double top = 0.008;
  spec.objects = {mesh_object("cube", models::cube(4, 0.05), {0, 0, top - 0.025})};
  Loop loop = loop_over(spec);
  loop.tool_tip = {-0.0005, 0, top - 0.025};
  loop.tick(2);
  EXPECT_EQ(loop.out.why & kSurfaceJump, 0U);
  loop.tool_tip = {-0.0004, 0, top - 0.025};
  loop.tick();
  EXPECT_EQ(loop.out.why & kSurfaceJump, 0U);
  loop.tool_tip = {0.0004, 0, top - 0.025};  // the opposite side is nearer now, 50 mm away
  loop.tick();
  EXPECT_NE(loop.out.why & kSurfaceJump, 0U);
  loop.tick();
  EXPECT_EQ(loop.out.why & kSurfaceJump, 0U) << "once";
}

// A tool goes along the row at an even 0.1 m/s. Return the place where the next ball takes over from the
// first.
double takes_over_at(double ahead, double height) {
  SceneSpec spec = balls(2);
  spec.follow.ahead = ahead;
  Loop loop = loop_over(spec);
  for (int k = 0; k < 600; ++k) {
    loop.tool_tip = {-0.05 + 1e-4 * k, 0, height};
    loop.tick();
    const Object& object = loop.scene.objects[static_cast<std::size_t>(loop.out.object)];
    // The gap is the present one, whichever object it is.
    const double gap = object.surface.nearest(object.X_WO.inverse() * loop.tool_tip).distance -
                       loop.scene.tools[0].tip.radius;
    EXPECT_NEAR(loop.out.gap, gap, 1e-4) << k;
    if (loop.out.object == 1) return loop.tool_tip.xyz[0];
  }
  return kUnset;
}

TEST(Touch, LooksAheadByAsMuchAsTheToolWillGo) {
  const double now = takes_over_at(0.0, 0.040), ahead = takes_over_at(0.060, 0.040);
  EXPECT_NEAR(now - ahead, 0.1 * 0.060, 1e-3);
}

// Half a second ahead the tool would be 50 mm farther, behind both balls; but prediction ends at the present
// gap.
TEST(Touch, DoesNotLookThroughASurface) {
  const double now = takes_over_at(0.0, 0.0105), ahead = takes_over_at(0.5, 0.0105);
  EXPECT_GT(now - ahead, 0.002);
  EXPECT_LT(now - ahead, 0.006);  // the gap half way between the balls
}

// Nothing jumps over a smooth ball, however the tool moves.
TEST(Touch, OnABallNothingJumps) {
  Loop loop = loop_over(balls(1));
  for (int k = 0; k < 3000; ++k) {
    loop.tool_tip = along(k);
    loop.tick();
    ASSERT_EQ(loop.out.why & kSurfaceJump, 0U) << k;
  }
}

// A hand changes its tool [VHMR 3.2, 3.3]: the overlay follows at once, without a change in force. A contact
// that was expected too early is still one contact.

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

// Tool 0 over the ball's top, its tip's surface `gap` above the ball, until the tip waits under it.
void hover(Loop& loop, double gap) {
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + gap);
  loop.tick(1500);
}

// Press with 3 N until everything has settled.
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

// The first tool was fast; the tracker has only the position of the second.
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

// The tracker takes the pressing tool for the second tool, whose tip would be 30 mm higher or 15 mm deeper.
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
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.003);  // its true position
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
