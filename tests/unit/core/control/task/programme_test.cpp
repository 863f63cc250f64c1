// The programmes of a machine, driven by hand: poses, travel, test rig.
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/control/step.h"
#include "core/control/task/indentation/indentation.h"
#include "core/control/task/tracking/tracking.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::Loop, test::rig_scene;

// A machine that a procedure sends from pose to pose, driven by hand.

// A scene with [travel]; its jaws hold their tool from tick `grips` on.
struct TrackingLoop {
  explicit TrackingLoop(int grips = 0) : loop(made()) {
    for (int i = 0; i < 3; ++i) next({});
    from = grips;
  }
  static Scene made() {
    SceneSpec spec = test::ball_scene();
    spec.objects.clear();
    spec.behaviours.clear();
    spec.gripper.emplace();
    spec.travel.emplace();
    return prepare(spec, RigSpec{});
  }
  void next(const Pose<'W', 'H'>& to) {
    ++tick.index;
    tick.dt = from_seconds(loop.dt);
    tick.t += tick.dt;
    const bool holds = ticks++ >= from;
    in.grip = {{holds ? GripPhase::closed : phase, 0.006, 100.0, holds}, tick.t, Health::ok};
    in.wrench = {{Vec<'F'>(0, 0, -9), Vec<'F'>::zero()}, tick.t, Health::ok};
    in.tip.value.X_RH = out.manipulator.tip.valid() ? out.manipulator.tip : loop.reach.machine.zero();
    in.tip.value.velocity = in.tip.value.acceleration = Vec<'R'>::zero();
    in.tip.t = tick.t;
    in.tip.health = Health::ok;
    carry(loop, tick, in, to, state, out);
  }
  [[nodiscard]] Pose<'W', 'H'> at() const { return loop.X_WR * out.manipulator.tip; }
  Scene loop;
  Tick tick;
  Inputs in;
  State state;
  Outputs out;
  int ticks = 0, from = 0;
  GripPhase phase = GripPhase::closing;  // before that
};

const Pose<'W', 'H'> kTo(Quat(Eigen::AngleAxisd(0.1, Vec3::UnitX())), Vec3(0.010, -0.005, 0.004));

TEST(Carry, GoesThereWithinTheMachinesLimitsAndTurnsAsItIsTold) {
  TrackingLoop sent;
  const Reach& reach = sent.loop.reach;
  Vec3 before = sent.at().p(), speed = Vec3::Zero();
  for (int i = 0; i < 1500; ++i) {
    sent.next(kTo);
    ASSERT_EQ(sent.out.mode, Mode::travel) << why_text(sent.out.why);
    const Vec3 velocity = (sent.at().p() - before) / sent.loop.dt;
    EXPECT_LE(velocity.norm(), reach.speed * (1 + 1e-9));
    EXPECT_LE((velocity - speed).norm(), reach.acceleration * sent.loop.dt * (1 + 1e-6));
    speed = velocity;
    before = sent.at().p();
    EXPECT_LT(sent.at().q().angularDistance(kTo.q()), 1e-9);
  }
  EXPECT_LT((sent.at().p() - kTo.p()).norm(), 2e-6);
}

TEST(Carry, WaitsForTheJawsAndWhereNothingIsAsked) {
  TrackingLoop sent(200);
  for (int i = 0; i < 150; ++i) sent.next(kTo);
  EXPECT_LT(sent.at().p().norm(), 1e-9) << "it moved before the tool was held";
  EXPECT_LT(sent.at().q().angularDistance(Quat::Identity()), 1e-12) << "it turned before the tool was held";
  for (int i = 0; i < 500; ++i) sent.next({});
  EXPECT_LT(sent.at().p().norm(), 1e-9) << "it went to the stops of its travel";
  EXPECT_LT(sent.at().q().angularDistance(Quat::Identity()), 1e-12);
  for (int i = 0; i < 500; ++i) sent.next(kTo);
  EXPECT_GT(sent.at().p().norm(), 5e-3);
}

// Turned by a little more in each tick, as in a slow manual rotation.
Pose<'W', 'H'> a_little_turned(int i) {
  return {Quat(Eigen::AngleAxisd(1e-4 * i, Vec3::UnitX())), Vec3(kTo.p())};
}

TEST(Carry, JawsThatNoLongerHoldLetItNeitherGoNorTurn) {
  TrackingLoop sent;
  for (int i = 1; i <= 100; ++i) sent.next(a_little_turned(i));
  sent.phase = GripPhase::opening;  // no hold: a hand may be taking the tool out
  sent.from = 1 << 30;
  for (int i = 101; i <= 150; ++i) sent.next(a_little_turned(i));
  const Pose<'W', 'H'> stood = sent.at();
  EXPECT_NEAR(stood.q().angularDistance(Quat::Identity()), 0.010, 1e-9);
  for (int i = 151; i <= 600; ++i) sent.next(a_little_turned(i));
  EXPECT_NE(sent.out.mode, Mode::hold);
  EXPECT_LT(sent.at().q().angularDistance(stood.q()), 1e-12);
  EXPECT_LT((sent.at().p() - stood.p()).norm(), 1e-3) << "it brakes";
}

TEST(Carry, ToolThatIsLostHoldsTheMachine) {
  TrackingLoop sent;
  for (int i = 1; i <= 100; ++i) sent.next(a_little_turned(i));
  sent.phase = GripPhase::closed;  // on nothing
  sent.from = 1 << 30;
  for (int i = 101; i <= 400; ++i) sent.next(a_little_turned(i));
  EXPECT_EQ(sent.out.mode, Mode::hold);
  EXPECT_NEAR(sent.at().q().angularDistance(Quat::Identity()), 0.010, 1e-9) << "it turned on in a hold";
  EXPECT_NE(sent.out.why & kToolNotHeld, 0U);
  const Vec3 stood = sent.at().p();
  for (int i = 0; i < 100; ++i) sent.next(kTo);
  EXPECT_LT((sent.at().p() - stood).norm(), 1e-9);
  EXPECT_TRUE(sent.out.manipulator.grip.closed);
}

// The travel programme, driven by hand with a machine that is always at its commanded place.

SceneSpec travel_scene() {
  SceneSpec spec = test::ball_scene();
  spec.objects.clear();
  spec.behaviours.clear();
  spec.force.reset();
  spec.gripper.emplace();
  TravelSpec& travel = spec.travel.emplace();
  travel.axes = "x";
  travel.stops = {0.0, 0.010, 0.040};
  travel.dwell = 0.2;
  travel.speed = 0.040;
  return spec;
}
Scene made(const SceneSpec& spec) { return prepare(spec, RigSpec{}); }

// A loop whose gripper holds its tool from `tick` on.
Loop with_grip(const SceneSpec& spec, int from = 0) {
  Loop loop(made(spec));
  loop.spoil = [from, ticks = 0](Inputs& in) mutable {
    in.grip = {{GripPhase::closing, 0.010, 0.0, false}, in.tip.t, Health::ok};
    if (ticks++ >= from) in.grip.value = {GripPhase::closed, 0.006, 100.0, true};
  };
  return loop;
}
int until(Loop& loop, TravelPhase phase, std::int32_t leg) {
  int ticks = 0;
  while ((recall<TrackingState>(loop.state).phase != phase || recall<TrackingState>(loop.state).leg != leg) &&
         ticks < 60'000) {
    loop.tick();
    ++ticks;
  }
  return ticks;
}
std::string refusal(const SceneSpec& spec) {
  try {
    made(spec);
  } catch (const Error& e) {
    return e.key();
  }
  return "nothing";
}

TEST(Travel, LegsOfEachAxisAndWay) {
  SceneSpec spec = travel_scene();
  spec.travel->axes = "xz";
  spec.travel->ways = TravelWays::both_ways;
  spec.travel->repeats = 2;
  const TrackingTask travel = *made(spec).tracking();
  ASSERT_EQ(travel.legs.size(), 2U * 2U * 5U);
  EXPECT_EQ(travel.legs[0].axis, -1);  // x begins where the machine is
  EXPECT_EQ(travel.legs[0].length, 0.0);
  EXPECT_EQ(travel.legs[1].way, 1);
  EXPECT_EQ(travel.legs[2].axis, 0);
  EXPECT_LT((travel.legs[2].to - Point<'W'>(0.040, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(travel.legs[3].way, -1);
  EXPECT_LT((travel.legs[5].to - Point<'W'>(0, 0, -0.020)).norm(), 1e-15);
  EXPECT_EQ(travel.legs[6].axis, 2);
  EXPECT_LT((travel.legs[7].to - Point<'W'>(0, 0, 0.020)).norm(), 1e-15);
}

TEST(Travel, WaitsForTheJawsThenMovesInTrapezoids) {
  Loop loop = with_grip(travel_scene(), 300);
  loop.tick(300);
  EXPECT_EQ(loop.out.mode, Mode::travel);
  EXPECT_EQ(recall<TrackingState>(loop.state).phase, TravelPhase::wait);
  EXPECT_LT(loop.tip().e().norm(), 1e-12);
  until(loop, TravelPhase::move, 2);  // 10 to 40 mm
  const double top = 0.040, a = loop.scene.reach.acceleration;
  // Half a ramp, with the whole acceleration; then even; 30 mm in 30 / 40 + 40 / 410 s.
  loop.tick(49);
  EXPECT_NEAR(recall<CommandState>(loop.state).command_velocity.norm(), a * 0.050, 1e-9);
  loop.tick(200);
  EXPECT_NEAR(recall<CommandState>(loop.state).command_velocity.norm(), top, 1e-9);
  const int rest = until(loop, TravelPhase::dwell, 2);
  EXPECT_NEAR((250 + rest) * 1e-3, 0.030 / top + top / a, 0.015);
  EXPECT_NEAR(loop.tip().xyz[0], 0.040, 1.1e-6);
  EXPECT_LT(std::abs(loop.tip().xyz[1]) + std::abs(loop.tip().xyz[2]), 1e-12);
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
}

TEST(Travel, EndsInItsTimeAndStandsStill) {
  SceneSpec spec = travel_scene();
  spec.travel->axes = "xyz";
  spec.travel->ways = TravelWays::both_ways;
  Loop loop = with_grip(spec);
  const double longest = loop.scene.tracking()->duration();
  const int ticks = until(loop, TravelPhase::done, 14);
  EXPECT_LT(ticks * 1e-3, longest);
  EXPECT_GT(ticks * 1e-3, longest - 2.6);
  const Point<'W'> there = loop.tip();
  loop.tick(500);
  EXPECT_EQ((loop.tip() - there).norm(), 0.0);
  EXPECT_TRUE(loop.always_reachable);
}

TEST(Travel, TimeStandsStillInAHold) {
  Loop loop = with_grip(travel_scene());
  until(loop, TravelPhase::dwell, 1);
  const double elapsed = recall<TrackingState>(loop.state).elapsed;
  const auto hold = loop.spoil;
  loop.spoil = [&](Inputs& in) { in.grip = {{GripPhase::closed, 0.0, 0.0, false}, in.tip.t, Health::ok}; };
  loop.tick(500);
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_NE(loop.out.why & kToolNotHeld, 0U);
  EXPECT_EQ(recall<TrackingState>(loop.state).elapsed, elapsed);
  loop.spoil = hold;
  EXPECT_NEAR(until(loop, TravelPhase::move, 2), 200, 3);
}

TEST(Travel, RefusesWhatTheMachineCannotDo) {
  EXPECT_EQ(refusal(travel_scene()), "nothing");
  const auto changed = [](const auto& change) {
    SceneSpec spec = travel_scene();
    change(spec);
    return refusal(spec);
  };
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->axes = "xw"; }), "travel.axes");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->axes = ""; }), "travel.axes");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->stops = {0.0}; }), "travel.stops");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->stops = {0.0, 0.02, 0.01}; }), "travel.stops");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->stops = {0.0, 0.090}; }), "travel.stops");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->speed = 0.060; }), "travel.speed");
  EXPECT_EQ(changed([](SceneSpec& s) {
              s.travel->axes = "z";
              s.travel->start = Vec3::Zero();
            }),
            "travel.stops");  // 40 mm above the zero
  EXPECT_EQ(changed([](SceneSpec& s) { s.gripper.reset(); }), "travel");
  EXPECT_EQ(changed([](SceneSpec& s) { s.user.emplace(); }), "travel");
  EXPECT_EQ(changed([](SceneSpec& s) { s.display.emplace(); }), "display");
}

// The programme of the test rig, driven by hand with a machine that is always at its commanded place.

constexpr double kProbeRadius = 0.010;  // m
constexpr double kCentre = 0.052;       // m, of the ball above W: first touch at 52 - 33 - 10 = 9 mm

// Tick until the programme reaches a phase; return the number of ticks.
int until(Loop& loop, ProbePhase phase) {
  int ticks = 0;
  while (recall<IndentationState>(loop.state).phase != phase && ticks < 60'000) {
    loop.tick();
    ++ticks;
  }
  return ticks;
}
double depth(const Loop& loop) { return loop.scene.indentation()->deflection(loop.tip()); }

TEST(IndentationTask, FirstTouchAndAxisOfTheThreeIndentations) {
  SceneSpec spec = rig_scene();
  const Scene a = made(spec);
  EXPECT_EQ(a.tip_radius, kProbeRadius);
  EXPECT_LT((a.indentation()->X_WN.p() - Vec3(0, 0, 0.009)).norm(), 1e-12);
  EXPECT_LT((a.indentation()->X_WN.q() * Vec3::UnitZ() - Vec3(0, 0, -1)).norm(), 1e-12);
  EXPECT_NEAR(a.indentation()->deflection(Point<'W'>(0.001, 0, 0.011)), 0.002, 1e-12);

  spec.probe->offset = 0.010;  // towards growing polar angle: at azimuth 0 and from below that is -x
  const Scene b = made(spec);
  EXPECT_LT((b.indentation()->X_WN.p() - Vec3(-0.010, 0, kCentre - std::sqrt(0.043 * 0.043 - 0.010 * 0.010)))
                .norm(),
            1e-11);
  EXPECT_LT((b.indentation()->X_WN.q() * Vec3::UnitZ() - Vec3(0, 0, -1)).norm(), 1e-12);

  spec.probe->offset = 0.0;
  spec.probe->polar = 170.0 * M_PI / 180.0;
  const Scene c = made(spec);
  const Vec3 out(std::sin(10.0 * M_PI / 180.0), 0, -std::cos(10.0 * M_PI / 180.0));
  EXPECT_LT((c.indentation()->X_WN.p() - (Vec3(0, 0, kCentre) + 0.043 * out)).norm(), 1e-12);
  EXPECT_LT((c.indentation()->X_WN.q() * Vec3::UnitZ() - out).norm(), 1e-12);
}

TEST(IndentationTask, WalksThroughItsPhases) {
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
  // 10 mm at 4 mm/s, and a little for acceleration and braking.
  loop.tick(1250);
  const double middle = depth(loop);
  loop.tick(100);
  EXPECT_NEAR((depth(loop) - middle) / 0.1, 0.004, 1e-6);
  EXPECT_NEAR(loop.out.deflection, depth(loop), 5e-6);  // depth of the measured tip, one tick ago
  const int rest_of_push = until(loop, ProbePhase::dwell);
  EXPECT_NEAR(1350 + rest_of_push, 2500, 30);
  EXPECT_NEAR(depth(loop), 0.006, 1.1e-6);
  EXPECT_NEAR(until(loop, ProbePhase::rest), 2500, 40);
  EXPECT_NEAR(depth(loop), -0.004, 1.1e-6);
}

TEST(IndentationTask, MakesItsRepeatsInItsTimeAndNeverGoesDeeper) {
  SceneSpec spec = rig_scene();
  spec.probe->repeats = 3;
  spec.probe->rest = 0.5;
  spec.probe->dwell = 0.2;
  Loop loop(made(spec));
  const double longest = programme_time(loop.scene, *loop.scene.indentation());
  double deepest = -1.0;
  int ticks = 0;
  for (; recall<IndentationState>(loop.state).phase != ProbePhase::done && ticks < 60'000; ++ticks) {
    loop.tick();
    deepest = std::max(deepest, depth(loop));
  }
  EXPECT_LE(ticks * 1e-3, longest);
  EXPECT_GT(ticks * 1e-3, 0.95 * longest);
  EXPECT_EQ(loop.out.contacts, 3);
  EXPECT_LE(deepest, 0.006 + 0.1e-6);  // the machine itself moves in steps of 3 um
  loop.tick(1000);
  EXPECT_EQ(loop.out.contacts, 3);
  EXPECT_NEAR(depth(loop), -0.004, 1.1e-6);
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  EXPECT_TRUE(loop.always_reachable);
}

// The programme pauses with the machine: it does not catch up by pushing faster.
TEST(IndentationTask, AHoldInAPushIsOnlyAPause) {
  Loop loop(made(rig_scene()));
  until(loop, ProbePhase::push);
  loop.tick(1500);
  loop.spoil = [](Inputs& in) { in.wrench.health = Health::fault; };
  loop.tick(20);
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_FALSE(loop.out.force_unfiltered.finite());
  const double stopped = depth(loop);
  loop.tick(300);
  EXPECT_NEAR(depth(loop), stopped, 1e-9);
  loop.spoil = nullptr;
  double before = depth(loop), fastest = 0.0;
  for (int i = 0; i < 500; ++i) {
    loop.tick();
    fastest = std::max(fastest, (depth(loop) - before) / 1e-3);
    before = depth(loop);
  }
  EXPECT_EQ(loop.out.mode, Mode::probe);
  EXPECT_LT(fastest, 1.1 * 0.004);  // as for a push that starts from rest
  EXPECT_GT(depth(loop), stopped + 0.0015);
}

// A push of the ball on the probe is positive along the axis, N's z; the unfiltered force has no lag.
TEST(IndentationTask, MeasuresForceAlongItsAxisWithoutLag) {
  Loop loop(made(rig_scene()));
  loop.force_zero = Vec<'F'>(0.3, -0.2, 0.5);
  until(loop, ProbePhase::push);
  loop.tick(1500);
  loop.force = Vec<'W'>(0.5, 0, -7.0);
  loop.tick();
  EXPECT_NEAR(loop.out.force_unfiltered.xyz[2], -7.0, 1e-9);
  EXPECT_NEAR(loop.out.force_unfiltered.xyz[0], 0.5, 1e-9);
  EXPECT_LT(loop.out.force.xyz[2], 1.0);  // filtered: has only begun
  loop.tick(1000);
  EXPECT_NEAR(loop.out.force.xyz[2], 7.0, 1e-6);
}

// While the probe is near the object the force zero stays, whatever the measurement.
TEST(IndentationTask, FindsItsForceZeroOnlyClearOfTheObject) {
  Loop loop(made(rig_scene()));
  until(loop, ProbePhase::push);
  const Vec<'F'> zero = recall<CommandState>(loop.state).force_zero;
  loop.force = Vec<'W'>(0, 0, -5.0);
  until(loop, ProbePhase::rest);
  EXPECT_EQ(recall<CommandState>(loop.state).force_zero.xyz, zero.xyz);
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

TEST(IndentationTask, RefusesWhatCannotBe) {
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

// Only the probe accepts a real object.
TEST(IndentationTask, AnObjectWithoutABehaviourIsRefusedWhereItWouldBeRendered) {
  SceneSpec spec = rig_scene();
  spec.probe.reset();
  expect_refused(spec, "object.ball.behaviour", "no behaviour ''");
}

}  // namespace
}  // namespace enc
