// The programme of the test rig, driven by hand: a machine that is where it was told to be.
#include "core/control/task/measure/probe.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::Loop;
using test::rig_scene;

constexpr double kProbeRadius = 0.010;  // m
constexpr double kCentre = 0.052;       // m, of the ball above W: first touch at 52 - 33 - 10 = 9 mm

Scene made(const SceneSpec& spec) { return prepare(spec, RigSpec{}); }

// Ticks until the programme is in a phase; gives how many.
int until(Loop& loop, ProbePhase phase) {
  int ticks = 0;
  while (recall<Probing>(loop.state).phase != phase && ticks < 60'000) {
    loop.tick();
    ++ticks;
  }
  return ticks;
}
double depth(const Loop& loop) { return loop.scene.probe()->deflection(loop.tip()); }

TEST(Probe, FirstTouchAndAxisOfTheThreeIndentations) {
  SceneSpec spec = rig_scene();
  const Scene a = made(spec);
  EXPECT_EQ(a.tip_radius, kProbeRadius);
  EXPECT_LT((a.probe()->X_WN.p() - Vec3(0, 0, 0.009)).norm(), 1e-12);
  EXPECT_LT((a.probe()->X_WN.q() * Vec3::UnitZ() - Vec3(0, 0, -1)).norm(), 1e-12);
  EXPECT_NEAR(a.probe()->deflection(Point<'W'>(0.001, 0, 0.011)), 0.002, 1e-12);

  spec.probe->offset = 0.010;  // towards growing polar angle: at azimuth 0 and from below that is -x
  const Scene b = made(spec);
  EXPECT_LT(
      (b.probe()->X_WN.p() - Vec3(-0.010, 0, kCentre - std::sqrt(0.043 * 0.043 - 0.010 * 0.010))).norm(),
      1e-11);
  EXPECT_LT((b.probe()->X_WN.q() * Vec3::UnitZ() - Vec3(0, 0, -1)).norm(), 1e-12);

  spec.probe->offset = 0.0;
  spec.probe->polar = 170.0 * M_PI / 180.0;
  const Scene c = made(spec);
  const Vec3 out(std::sin(10.0 * M_PI / 180.0), 0, -std::cos(10.0 * M_PI / 180.0));
  EXPECT_LT((c.probe()->X_WN.p() - (Vec3(0, 0, kCentre) + 0.043 * out)).norm(), 1e-12);
  EXPECT_LT((c.probe()->X_WN.q() * Vec3::UnitZ() - out).norm(), 1e-12);
}

TEST(Probe, WalksThroughItsPhases) {
  Loop loop(made(rig_scene()));
  loop.tick();
  EXPECT_EQ(loop.out.mode, Mode::probe);
  EXPECT_NE(loop.out.why & kTaring, 0U);
  EXPECT_NEAR(loop.out.gap, 0.009, 1e-12);
  EXPECT_NEAR(until(loop, ProbePhase::approach), 200, 2);  // 0.2 s of force zero
  EXPECT_LT(loop.tip().e().norm(), 0.42e-6);               // it has just begun to move: 0.41 m/s^2 for a tick
  until(loop, ProbePhase::rest);
  EXPECT_NEAR(depth(loop), -0.004, 1.1e-6);
  EXPECT_EQ(loop.out.contacts, 0);
  EXPECT_NEAR(until(loop, ProbePhase::push), 2000, 2);
  EXPECT_EQ(loop.out.contacts, 1);
  // 10 mm at 4 mm/s, and a little for speeding up and stopping.
  loop.tick(1250);
  const double middle = depth(loop);
  loop.tick(100);
  EXPECT_NEAR((depth(loop) - middle) / 0.1, 0.004, 1e-6);
  EXPECT_NEAR(loop.out.deflection, depth(loop), 5e-6);  // of the tip as measured, one tick ago
  const int rest_of_push = until(loop, ProbePhase::dwell);
  EXPECT_NEAR(1350 + rest_of_push, 2500, 30);
  EXPECT_NEAR(depth(loop), 0.006, 1.1e-6);
  EXPECT_NEAR(until(loop, ProbePhase::rest), 2500, 40);
  EXPECT_NEAR(depth(loop), -0.004, 1.1e-6);
}

TEST(Probe, MakesItsRepeatsInItsTimeAndNeverGoesDeeper) {
  SceneSpec spec = rig_scene();
  spec.probe->repeats = 3;
  spec.probe->rest = 0.5;
  spec.probe->dwell = 0.2;
  Loop loop(made(spec));
  const double longest = programme_time(loop.scene, *loop.scene.probe());
  double deepest = -1.0;
  int ticks = 0;
  for (; recall<Probing>(loop.state).phase != ProbePhase::done && ticks < 60'000; ++ticks) {
    loop.tick();
    deepest = std::max(deepest, depth(loop));
  }
  EXPECT_LE(ticks * 1e-3, longest);
  EXPECT_GT(ticks * 1e-3, 0.95 * longest);
  EXPECT_EQ(loop.out.contacts, 3);
  EXPECT_LE(deepest, 0.006 + 0.1e-6);  // the machine itself goes in steps of 3 um
  loop.tick(1000);
  EXPECT_EQ(loop.out.contacts, 3);
  EXPECT_NEAR(depth(loop), -0.004, 1.1e-6);
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  EXPECT_TRUE(loop.always_reachable);
}

// The programme stands still with the machine: it does not catch up by pushing faster.
TEST(Probe, AHoldInAPushIsOnlyAPause) {
  Loop loop(made(rig_scene()));
  until(loop, ProbePhase::push);
  loop.tick(1500);
  loop.spoil = [](Inputs& in) { in.wrench.health = Health::fault; };
  loop.tick(20);
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_FALSE(loop.out.felt.finite());
  const double stopped = depth(loop);
  loop.tick(300);
  EXPECT_NEAR(depth(loop), stopped, 1e-9);
  loop.spoil = nullptr;
  double before = depth(loop);
  double fastest = 0.0;
  for (int i = 0; i < 500; ++i) {
    loop.tick();
    fastest = std::max(fastest, (depth(loop) - before) / 1e-3);
    before = depth(loop);
  }
  EXPECT_EQ(loop.out.mode, Mode::probe);
  EXPECT_LT(fastest, 1.1 * 0.004);  // as when a push starts from rest
  EXPECT_GT(depth(loop), stopped + 0.0015);
}

// A push of the ball on the probe is positive along the axis, which is N's z; the unfiltered force has no
// lag.
TEST(Probe, MeasuresForceAlongItsAxisWithoutLag) {
  Loop loop(made(rig_scene()));
  loop.force_zero = Vec<'F'>(0.3, -0.2, 0.5);
  until(loop, ProbePhase::push);
  loop.tick(1500);
  loop.force = Vec<'W'>(0.5, 0, -7.0);
  loop.tick();
  EXPECT_NEAR(loop.out.felt.xyz[2], -7.0, 1e-9);
  EXPECT_NEAR(loop.out.felt.xyz[0], 0.5, 1e-9);
  EXPECT_LT(loop.out.force.xyz[2], 1.0);  // filtered: has only begun
  loop.tick(1000);
  EXPECT_NEAR(loop.out.force.xyz[2], 7.0, 1e-6);
}

// While the probe is near the object the force zero stays what it was, whatever is measured.
TEST(Probe, FindsItsForceZeroOnlyClearOfTheObject) {
  Loop loop(made(rig_scene()));
  until(loop, ProbePhase::push);
  const Vec<'F'> zero = recall<Commanded>(loop.state).force_zero;
  loop.force = Vec<'W'>(0, 0, -5.0);
  until(loop, ProbePhase::rest);
  EXPECT_EQ(recall<Commanded>(loop.state).force_zero.xyz, zero.xyz);
}

void expect_refused(const SceneSpec& spec, const std::string& key, const std::string& words) {
  try {
    made(spec);
    ADD_FAILURE() << "not refused: " << words;
  } catch (const Error& e) {
    EXPECT_EQ(e.key(), key) << e.what();
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
  }
}

TEST(Probe, RefusesWhatCannotBe) {
  SceneSpec spec = rig_scene();
  spec.probe->depth = 0.0101;
  expect_refused(spec, "probe.depth", "no deeper than the radius");
  spec = rig_scene();
  spec.probe->radius = 0.0;
  expect_refused(spec, "probe.radius", "needs a radius");
  spec = rig_scene();
  spec.probe->speed = 0.051;
  expect_refused(spec, "probe.speed", "cannot push that fast");
  spec = rig_scene();
  spec.probe->polar = 0.0;
  expect_refused(spec, "probe.polar", "pushes upwards");
  spec = rig_scene();
  spec.probe->offset = 0.0431;
  expect_refused(spec, "probe.offset", "past the object");
  spec = rig_scene();
  spec.objects[0].position = Vec3(0, 0, 0.080);
  expect_refused(spec, "probe.object", "outside the machine's reach");
  spec = rig_scene();
  spec.objects[0].position = Vec3(0, 0, 0.045);  // 2 mm over the probe
  expect_refused(spec, "probe.object", "in the way of the probe");
  spec = rig_scene();
  spec.probe->object = "cup";
  expect_refused(spec, "probe.object", "no object 'cup'");
  spec = rig_scene();
  spec.force.reset();
  expect_refused(spec, "probe", "[force]");
  spec = rig_scene();
  spec.tracker.emplace();
  expect_refused(spec, "tracker", "nothing to track");
  spec = rig_scene();
  spec.display.emplace();
  expect_refused(spec, "display", "nothing to show");
  spec = rig_scene();
  spec.user.emplace();
  expect_refused(spec, "user", "either the machine presses");
}

// A real thing is for the probe alone.
TEST(Probe, AnObjectWithoutABehaviourIsRefusedWhereItWouldBeRendered) {
  SceneSpec spec = rig_scene();
  spec.probe.reset();
  expect_refused(spec, "object.ball.behaviour", "no behaviour ''");
}

}  // namespace
}  // namespace enc
