// prepare(): the parts that it prepares, and the scenes that it refuses before anything moves. The objects
// that stand still under a hand.
#include "core/control/scene/scene.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/control/scene/steadiness.h"
#include "core/spec/rig_spec.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

void expect_refused(const SceneSpec& spec, const std::string& words, const std::string& key,
                    const RigSpec& rig = {}) {
  try {
    (void)prepare(spec, rig);
    ADD_FAILURE() << "accepted, where '" << words << "' was expected";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    EXPECT_EQ(e.key(), key) << e.what();
    EXPECT_EQ(e.kind(), ErrorKind::input);
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
  }
}

TEST(Prepare, TakesTheScenesOfTheTests) {
  const Scene scene = prepare(test::ball_scene(), {});
  EXPECT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].limit, 0.006);
  EXPECT_TRUE(scene.has_manipulator && scene.has_force && scene.has_tracker && !scene.has_display);
  EXPECT_EQ(scene.dt, 0.001);
  EXPECT_NEAR(scene.filter_gain, 1.0 - std::exp(-2.0 * M_PI * 5.0 * 0.001), 1e-15);
  EXPECT_NO_THROW((void)prepare(test::plane_scene(), {}));
  EXPECT_NO_THROW((void)prepare(test::ball_scene(test::lossy_ball()), {}));
}

TEST(Prepare, HIsWAtTheMachinesZero) {
  const Scene scene = prepare(test::ball_scene(), {});
  const Pose<'W', 'H'> X_WH = scene.X_WR * scene.reach.machine.zero();
  EXPECT_LT(X_WH.p().norm(), 1e-15);
  EXPECT_LT(X_WH.q().coeffs().head<3>().norm(), 1e-15);
}

RigSpec turned_rig() {
  RigSpec rig;
  rig.frames.W_S.rotation = {0.1, -0.2, 0.3};
  rig.frames.W_C.rotation = {-0.4, 0.5, 2.0};
  rig.frames.G_L.rotation = {0.2, 0.3, -0.1};
  rig.frames.H_F.rotation = {0.1, 0.2, 0.6};
  return rig;
}

TEST(Chains, CloseOverTrackerMachineForceAndObjects) {
  for (const SceneSpec& spec : {test::ball_scene(), test::plane_scene(), test::two_balls(), test::rig_scene(),
                                test::mesh_scene(test::box(0.06, 0.05, 0.04), -0.012, {0.1, -0.2, 0.3})})
    EXPECT_LT(chain_residual(spec, turned_rig(), prepare(spec, turned_rig())), 1e-9);
}

// A frame that is off by a micrometre or turned by a microradian shows up, and so do two swapped frames.
TEST(Chains, AWrongFrameShows) {
  const SceneSpec spec = test::mesh_scene(test::box(0.06, 0.05, 0.04), -0.012, {0.1, -0.2, 0.3});
  const RigSpec rig = turned_rig();
  const Scene right = prepare(spec, rig);
  const auto shows = [&](const char* what, const auto& spoil) {
    Scene wrong = right;
    spoil(wrong);
    EXPECT_GT(chain_residual(spec, rig, wrong), 0.5e-6) << what;
  };
  const auto each = [&](const char* what, auto frame_of) {
    shows(what, [&](Scene& s) { frame_of(s).xyz[1] += 1e-6; });
    shows(what, [&](Scene& s) {
      auto& X = frame_of(s);
      X = {X.q() * Quat(1.0, 0.0, 0.5e-6, 0.0), Vec3(X.p())};
    });
  };
  each(
      "X_WR", [](Scene & s) -> auto& { return s.X_WR; });
  each(
      "X_WC", [](Scene & s) -> auto& { return s.X_WC; });
  each(
      "X_WS", [](Scene & s) -> auto& { return s.X_WS; });
  each(
      "X_GL", [](Scene & s) -> auto& { return s.X_GL; });
  each(
      "X_HF", [](Scene & s) -> auto& { return s.X_HF; });
  each(
      "X_WO", [](Scene & s) -> auto& { return s.objects[0].X_WO; });
  each(
      "X_OW", [](Scene & s) -> auto& { return s.objects[0].X_OW; });
  shows("X_WC for X_WS", [](Scene& s) { s.X_WC = {Quat(s.X_WS.q()), Vec3(s.X_WS.p())}; });
  shows("X_CW for X_WC", [](Scene& s) {
    const auto X_CW = s.X_WC.inverse();
    s.X_WC = {Quat(X_CW.q()), Vec3(X_CW.p())};
  });
  shows("a tool's tip", [](Scene& s) { s.tools[0].tip.centre.xyz[2] += 1e-6; });
}

TEST(Prepare, RefusesAnObjectOutOfReach) {
  SceneSpec spec = test::ball_scene();
  spec.objects[0].position.x() = 0.5;
  expect_refused(spec, "object 'ball' is outside the machine's reach", "object.ball.position");
  spec = test::plane_scene();
  spec.objects[0].position.z() = 0.2;
  expect_refused(spec, "object 'plane' is outside the machine's reach", "object.plane.position");
}

TEST(Prepare, RefusesAPressOutOfReach) {
  SceneSpec spec = test::ball_scene();
  spec.user.emplace();
  EXPECT_NO_THROW((void)prepare(spec, {}));
  spec.user->polar = M_PI;  // pressed from below: 66 mm deeper
  expect_refused(spec, "the user presses where the machine does not reach", "user.polar");
}

TEST(Prepare, RefusesAnUnknownBehaviour) {
  SceneSpec spec = test::ball_scene();
  spec.objects[0].behaviour = "jelly";
  expect_refused(spec, "no behaviour 'jelly'", "object.ball.behaviour");
}

TEST(Prepare, RefusesALimitAboveTheResponses) {
  SceneSpec spec = test::ball_scene();
  for (const double limit : {0.0061, 0.0, -0.001}) {
    spec.objects[0].limit = limit;
    expect_refused(spec, "deflection limit", "object.ball.limit");
  }
  spec.objects[0].limit = 0.004;
  EXPECT_EQ(prepare(spec, {}).objects[0].limit, 0.004);
  spec.objects[0].limit = std::nextafter(0.006, 1.0);  // rounded, which is no deeper
  EXPECT_EQ(prepare(spec, {}).objects[0].limit, 0.006);
}

// A scene made in code obeys the same limits as a file: one rule checks both.
TEST(Prepare, RefusesTheLimitsThatAFileMayNotHave) {
  const auto refused = [](LimitFault fault, double limit, std::vector<double> limits, double radius = 0.033) {
    SceneSpec spec = test::ball_scene();
    spec.objects[0].limit = limit;
    spec.objects[0].limits = std::move(limits);
    spec.objects[0].radius = radius;
    EXPECT_EQ(check_limits(spec.objects[0], 0.006).fault, fault);
    expect_refused(spec, "deflection limit",
                   spec.objects[0].limits.empty() ? "object.ball.limit" : "object.ball.limits");
  };
  refused(LimitFault::two_keys, 0.004, {0.004});
  refused(LimitFault::too_many, kUnset, std::vector<double>(ContactLimits::kMost + 1, 0.004));
  refused(LimitFault::not_positive, kUnset, {0.006, 0.0});
  refused(LimitFault::beyond_behaviour, kUnset, {0.004, 0.007});
  refused(LimitFault::beyond_radius, 0.004, {}, 0.003);
}

TEST(Prepare, RefusesAResponseSofterThanTheLoopRenders) {
  const double floor = prepare(test::ball_scene(), {}).lowest_slope;
  EXPECT_GT(floor, 20.0);
  EXPECT_LT(floor, 400.0);
  expect_refused(test::ball_scene(test::spring(0.9 * floor)), "is softer than the loop renders stably",
                 "behaviour.spring.curves.press");
  EXPECT_NO_THROW((void)prepare(test::ball_scene(test::spring(1.01 * floor)), {}));
}

TEST(Prepare, RefusesAFallingCurveAndNamesTheInterval) {
  BehaviourSpec behaviour = test::spring();
  // F = 1000 d - 1e5 d^2: slope 0 at 5 mm, falls up to 6 mm.
  behaviour.curves.press = behaviour.curves.release = {1000, -1e5, 0, 0};
  expect_refused(test::ball_scene(behaviour), "press curve falls with deflection from 5.0",
                 "behaviour.spring.curves.press");
}

TEST(Prepare, RefusesASceneWithoutAManipulator) {
  SceneSpec spec = test::ball_scene();
  spec.manipulator.reset();
  expect_refused(spec, "[manipulator]", "manipulator");
}

TEST(Prepare, RefusesWhatIsNoShape) {
  SceneSpec spec = test::ball_scene();
  spec.objects[0].radius = kUnset;
  expect_refused(spec, "a sphere needs a radius", "object.ball.radius");
  spec = test::plane_scene();
  spec.objects[0].normal = Vec3(0, 0, 2);
  expect_refused(spec, "unit vector", "object.plane.normal");
  spec.objects[0].normal = Vec3(kUnset, 0, 1);
  expect_refused(spec, "unit vector", "object.plane.normal");
  spec = test::ball_scene();
  spec.objects[0].radius = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)prepare(spec, {}), Error);
}

TEST(Prepare, RefusesASceneWithAUserButNothingToPress) {
  SceneSpec spec = test::ball_scene();
  spec.objects.clear();
  spec.user.emplace();
  EXPECT_THROW((void)prepare(spec, {}), Error);
}

TEST(Prepare, RefusesAUserWhoPressesAnUnknownObject) {
  SceneSpec spec = test::ball_scene();
  spec.user.emplace();
  spec.user->object = "bal";
  EXPECT_THROW((void)prepare(spec, {}), Error);
}

TEST(Prepare, RefusesASpringySidewaysWithoutAStiffness) {
  BehaviourSpec behaviour = test::spring();
  behaviour.tangential = TangentialMode::spring;
  expect_refused(test::ball_scene(behaviour), "needs a tangential stiffness", "object.ball.behaviour");
}

TEST(PressPointOf, IsOnTheSurfaceUnderTheUser) {
  const SceneSpec spec = test::ball_scene();
  UserSpec user;
  PressPoint press = press_point(spec, user);
  EXPECT_NEAR(press.point.xyz[2], test::kTop, 1e-15);
  user.polar = M_PI / 2;
  user.azimuth = M_PI / 2;
  press = press_point(spec, user);  // from +y
  EXPECT_LT((press.point - Point<'W'>(0, 0.033, test::kTop - 0.033)).norm(), 1e-15);
  EXPECT_LT((press.normal - Vec<'W'>(0, 1, 0)).norm(), 1e-15);
}

// Stability of an object under a hand, from the loop with its limits.

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
