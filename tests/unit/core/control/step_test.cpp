// step() driven by hand: each mode and each change of mode, the object in question, forces, the state.
#include "core/control/step.h"

#include <random>

#include <gtest/gtest.h>

#include "core/control/stages/step_context.h"
#include "core/control/task/tasks.h"
#include "core/record/state_hash.h"
#include "tests/support/by_hand.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::expect_within_limits, test::kBallRadius, test::kSkin, test::kTipRadius, test::kToolRadius,
    test::kTop, test::Loop, test::make, test::wait_under;

TEST(Follow, WaitsJustInsideTheSurfaceUnderTheTool) {
  Loop loop = make(test::ball_scene());
  wait_under(loop);
  // Tip centre = surface point - (radius 5 mm + inset 0.5 mm) n.
  EXPECT_NEAR(loop.tip().xyz[2], kTop - 0.0055, 1e-9);
  EXPECT_NEAR(loop.out.gap, 0.010, 1e-12);
  // 20 degrees aside: the nearest point turns by as much, seen from the centre.
  const double a = 20.0 * M_PI / 180.0;
  const Vec3 n(std::sin(a), 0, std::cos(a)), centre(0, 0, kTop - kBallRadius);
  loop.tool_tip = Point<'W'>(Vec3(centre + (kBallRadius + 0.030) * n));
  loop.tick(2000);
  EXPECT_LT((loop.tip().e() - (centre + (kBallRadius - 0.0055) * n)).norm(), 1e-9);
  EXPECT_LT(loop.worst_outside, 0.0);
  expect_within_limits(loop);
}

TEST(Follow, PausesBeyondAHundredMillimetresAndResumesAtNinety) {
  Loop loop = make(test::ball_scene());
  const auto at_gap = [&](double gap) {
    loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + gap);
    return loop.tick().mode;
  };
  loop.tick(300);
  EXPECT_EQ(at_gap(0.099), Mode::away);  // has not been nearer than 90 yet
  EXPECT_EQ(at_gap(0.0905), Mode::away);
  EXPECT_EQ(at_gap(0.0895), Mode::follow);
  EXPECT_EQ(at_gap(0.0995), Mode::follow);
  EXPECT_EQ(at_gap(0.1005), Mode::away);
  EXPECT_EQ(at_gap(0.0995), Mode::away);
  EXPECT_EQ(at_gap(0.0895), Mode::follow);
  // The tip brakes and stays during the pause.
  EXPECT_EQ(at_gap(0.2), Mode::away);
  loop.tick(200);
  const Point<'W'> waits = loop.tip();
  loop.tool_tip = Point<'W'>(0.1, 0, 0.25);
  loop.tick(100);
  EXPECT_EQ((loop.tip() - waits).norm(), 0.0);
}

TEST(Contact, BeginsByGapAtTheNearestPoint) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 1e-6);
  EXPECT_EQ(loop.tick().mode, Mode::contact);
  EXPECT_EQ(loop.out.contacts, 1);
  EXPECT_FALSE(loop.out.why & kByForce);
  EXPECT_NEAR(loop.out.first_touch.xyz[2], kTop - kTipRadius - kSkin, 1e-12);
  loop.tick(500);  // without force the tip comes up to the skin and no farther
  EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius - kSkin, 1e-9);
  EXPECT_LT(loop.worst_outside, 0.0);
}

TEST(Contact, BeginsByForceWhereTheTrackerSaysThereIsNone) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.003);
  // The tracker errs by +0.3 mm: the tool touches while the measured gap is 0.3 mm.
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.3e-3);
  loop.tick(10);
  EXPECT_EQ(loop.out.mode, Mode::follow);
  loop.force = Vec<'W'>(0, 0, -0.5);
  int until = 0;
  while (loop.out.mode == Mode::follow && until < 100) {
    loop.tick();
    ++until;
  }
  EXPECT_EQ(loop.out.mode, Mode::contact);
  // 0.1 N of 0.5 N after a 5 Hz low-pass: -ln(1 - 0.2) / (2 pi 5) = 7.1 ms.
  EXPECT_NEAR(until, 8, 1);
  EXPECT_TRUE(loop.out.why & kByForce);
  EXPECT_EQ(loop.out.contacts, 1);
}

TEST(Contact, TheSpringGivesByForceLessThreshold) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -4.05);
  loop.tick(3000);
  // (4.05 - 0.05) / 2000 = 2 mm.
  EXPECT_EQ(loop.out.mode, Mode::contact);
  EXPECT_NEAR(loop.out.deflection, 0.002, 1e-9);
  EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius - kSkin - 0.002, 1e-9);
  EXPECT_NEAR(loop.out.force.xyz[2], -4.05, 1e-9);
  EXPECT_FALSE(loop.out.why & kAtLimit);
}

TEST(Contact, IsOneForEachPressUnderNoiseAndBias) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const double bias : {-0.3e-3, 0.0, 0.3e-3}) {
    Loop loop = make(test::ball_scene());
    wait_under(loop, 0.010);
    const int presses = 10;
    for (int press = 0; press < presses; ++press) {
      for (int i = 0; i < 3000; ++i) {
        // True tool tip: 10 mm above the surface, down to 2 mm below within 1 s, stays 1 s, goes back.
        const double down = i < 1000 ? i / 1000.0 : i < 2000 ? 1.0 : 1.0 - (i - 2000) / 1000.0;
        const double z = kTop + kToolRadius + 0.010 - 0.012 * down;
        // The hand is a spring of 700 N/m against the real tip; it presses only while it touches.
        const double overlap = loop.tip().xyz[2] + kTipRadius + kToolRadius - z;
        loop.force = Vec<'W'>(0, 0, overlap > 0 ? -700.0 * overlap : 0.0) +
                     0.0125 * Vec<'W'>(normal(random), normal(random), normal(random));
        loop.tool_tip =
            Point<'W'>(2e-5 * normal(random), 2e-5 * normal(random), z + bias + 2e-5 * normal(random));
        loop.tick();
      }
      EXPECT_EQ(loop.out.contacts, press + 1) << "bias " << bias << " press " << press;
    }
    expect_within_limits(loop);
    EXPECT_LT(loop.worst_outside, 50e-6);
  }
}

TEST(Restore, GoesBackToTheBufferedPoint) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0.003, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -4.05);
  loop.tick(2000);  // the tip was still elsewhere when the gap closed: the anchor has moved,
                    // once, to the place of the force
  const Point<'W'> touched = loop.out.first_touch;
  EXPECT_GT((loop.tip() - touched).norm(), 1e-3);
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = Point<'W'>(0.003, 0, kTop + kToolRadius + 0.020);
  bool restored = false;
  for (int i = 0; i < 3000 && loop.tick().mode != Mode::follow; ++i) {
    if (loop.out.mode == Mode::restore) {
      restored = true;
      EXPECT_EQ((loop.out.first_touch - touched).norm(), 0.0);
    }
  }
  EXPECT_TRUE(restored);
  EXPECT_EQ(loop.out.mode, Mode::follow);
  EXPECT_LT((loop.tip() - touched).norm(),
            4e-6 + 50e-6);  // within ContactRig::restored, and at most one tick on the way inwards
  EXPECT_EQ(loop.out.contacts, 1);
}

TEST(Restore, PressedAgainOnTheWayIsANewContact) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -10.0);
  loop.tick(2000);
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.005);
  for (int i = 0; i < 2000 && loop.out.mode != Mode::restore; ++i) loop.tick();
  if (loop.out.mode != Mode::restore) GTEST_FAIL() << "never restored";
  loop.force = Vec<'W'>(0, 0, -10.0);
  for (int i = 0; i < 50 && loop.out.mode == Mode::restore; ++i) loop.tick();
  // Either the tip was back already and follow began the contact, or restore did: there are two contacts now.
  loop.tick(5);
  EXPECT_EQ(loop.out.mode, Mode::contact);
  EXPECT_EQ(loop.out.contacts, 2);
}

TEST(Restore, EndsAlsoWhereTheBufferedPointIsOutOfReach) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.020);
  // 100 degrees from the top the tip would have to be at z = -25 - 28 cos 80 = -30 mm; the machine ends at
  // about -25.
  const double a = 100.0 * M_PI / 180.0;
  const Vec3 centre(0, 0, kTop - kBallRadius), n(std::sin(a), 0, std::cos(a));
  loop.tool_tip = Point<'W'>(Vec3(centre + (kBallRadius + kToolRadius - 1e-4) * n));
  loop.tick(200);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.020);
  loop.tick(5000);
  EXPECT_EQ(loop.out.mode, Mode::follow) << mode_name(loop.out.mode) << ": " << why_text(loop.out.why);
}

TEST(Contact, EndsWhereTheToolIsFarAwayWhateverTheForceSays) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -2.0);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  // The sensor's zero has moved by 0.3 N meanwhile; a tracker does not err by 80 mm.
  loop.force = Vec<'W'>(0, 0, -0.3);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.080);
  loop.tick(5000);
  EXPECT_EQ(loop.out.mode, Mode::follow) << mode_name(loop.out.mode);
}

TEST(Contact, SlidingOffTheTipEndsItWithoutAGap) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -2.0);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  // 10 mm aside, which is more than both radii (7 mm), below the undeformed surface, and without a press.
  const double a = 10.0 / 33.0;
  loop.tool_tip = Point<'W'>(0.0335 * std::sin(a), 0, kTop - kBallRadius + 0.0335 * std::cos(a));
  loop.force = Vec<'W'>::zero();
  for (int i = 0; i < 1000 && loop.out.mode == Mode::contact; ++i) loop.tick();
  EXPECT_NE(loop.out.mode, Mode::contact);
}

// 0.1 to 20.0 mm, written as in a scene, for responses that end there or go on to 6 or 20 mm. A press held at
// the limit reports it, and its deflection equals the limit to the bit.
TEST(Contact, EveryLimitIsReached) {
  Scene scene = prepare(test::ball_scene(), test::exact_rig());
  Object& object = scene.objects[0];
  for (const Reversal reversal : {Reversal::energy_stop, Reversal::prandtl_ishlinskii})
    for (int tenths = 1; tenths <= 200; ++tenths) {
      const double limit = 1e-3 * (tenths / 10.0);
      for (const double curve : {limit, 0.006, 0.020}) {
        if (curve < limit) continue;
        ResponseSpec spec{.press = {2000.0}, .release = {1500.0}, .limit = curve};
        spec.stops = StopsSpec{{2000.0 * curve}, {0.001}, {100.0}};
        object.response = Response(spec, 100.0, reversal);
        object.limit = limit;
        const Tick tick;
        const Inputs in;
        State state;
        state.mode = Mode::contact;
        const AdmittanceTask task;
        AdmittanceState now;
        now.contact.object = 0;
        now.contact.X_WN = Pose<'W', 'N'>::identity();
        for (int i = 0; i < 3; ++i) {
          stages::AdmittanceContext context(scene, tick, in);
          context.force = Vec<'W'>(0, 0, -1000.0);
          stages::model(context, task, state, now);
          EXPECT_TRUE(context.why & kAtLimit) << tenths << " of " << curve;
          EXPECT_EQ(now.displacement.xyz[2], -limit) << tenths << " of " << curve;
        }
      }
    }
}

TEST(Contact, TheLimitIsHeldWhateverTheForce) {
  for (const double limit : {0.006, 0.004, 0.002}) {
    SceneSpec spec = test::ball_scene();
    spec.objects[0].limit = limit;
    Loop loop = make(spec);
    wait_under(loop, 0.001);
    loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
    loop.force = Vec<'W'>(0, 0, -30.0);
    double deepest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      loop.tick();
      deepest = std::max(deepest, kTop - kTipRadius - kSkin - loop.tip().xyz[2]);
    }
    EXPECT_TRUE(loop.out.why & kAtLimit);
    EXPECT_NEAR(loop.out.deflection, limit, 1e-12);
    EXPECT_LE(deepest, limit + 0.5e-3 + 1e-9);  // the inset of follow may have been deeper before
    EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius - kSkin - limit, 1e-9);
  }
}

SceneSpec two_balls() {
  SceneSpec spec = test::ball_scene();
  spec.objects.push_back(spec.objects[0]);
  spec.objects[0].position.x() = -0.035;
  spec.objects[1].position.x() = 0.035;
  spec.objects[1].name = "other";
  return spec;
}

TEST(Objects, TheNearerOneTakesOverWithHysteresis) {
  Loop loop = make(two_balls());
  int switches = 0;
  std::int32_t last = -1;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> noise(-0.4e-3, 0.4e-3);
  // Along x through the middle with +-0.4 mm of noise: the distances differ by less than the hysteresis of 1
  // mm.
  for (int i = -400; i <= 400; ++i) {
    loop.tool_tip = Point<'W'>(1e-4 * i + noise(random), 0, 0.05);
    loop.tick();
    if (i > -400 && loop.out.object != last) ++switches;
    last = loop.out.object;
  }
  EXPECT_EQ(switches, 1);
  EXPECT_EQ(last, 1);
}

TEST(Objects, AContactIsNotTakenAwayByANeighbour) {
  Loop loop = make(two_balls());
  const double x = -0.02;
  loop.tool_tip = Point<'W'>(x, 0, 0.04);
  loop.tick(2500);
  const Vec3 centre(-0.035, 0, kTop - kBallRadius);
  const Vec3 n = (loop.tool_tip.e() - centre).normalized();
  loop.tool_tip = Point<'W'>(Vec3(centre + (kBallRadius + kToolRadius - 1e-4) * n));
  loop.force = Vec<'W'>(Vec3(-2.0 * n));
  loop.tick(100);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.tool_tip = Point<'W'>(0.035, 0, 0.04);  // the tracker jumps to the second ball, the force stays
  loop.tick(20);
  EXPECT_EQ(loop.out.object, 0);
  EXPECT_EQ(loop.out.mode, Mode::contact);
}

// step() driven by hand: the measured force and the motion that a force causes.

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
void oblique(TangentialMode tangential) {
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
  // Touch at a place with a normal that is oblique in W as well.
  const Vec3 centre(0, 0, kTop - kBallRadius);
  const Vec3 n = (loop.tool_tip.e() - centre).normalized();
  loop.tool_tip = Point<'W'>(Vec3(centre + (kBallRadius + kToolRadius - 1e-4) * n));
  loop.tick();
  ASSERT_EQ(loop.out.mode, Mode::contact);
  const Vec3 side = n.unitOrthogonal();
  loop.force = Vec<'W'>(Vec3(-3.05 * n + 1.2 * side));
  loop.tick(4000);
  // Normal: (3.05 - 0.05) / 2000 = 1.5 mm inwards. Sideways: 1.2 / 4000 = 0.3 mm with the force, or nothing.
  const double sideways = tangential == TangentialMode::spring ? 0.3e-3 : 0.0;
  const Vec3 expected = centre + (kBallRadius - kTipRadius - kSkin - 1.5e-3) * n + sideways * side;
  EXPECT_LT((loop.tip().e() - expected).norm(), 1e-9);
  EXPECT_NEAR(loop.out.force.norm(), std::hypot(3.05, 1.2), 1e-9);
  expect_within_limits(loop);
}
TEST(Force, ObliqueOnATurnedSensorGivesTheExactDisplacementForStick) { oblique(TangentialMode::stick); }
TEST(Force, ObliqueOnATurnedSensorGivesTheExactDisplacementForSpring) { oblique(TangentialMode::spring); }

TEST(Force, InertiaOfWhatMovesIsNoContact) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.020);
  double felt = 0.0;
  for (int i = 0; i < 3000;
       ++i) {  // the tip moves to and fro at its limits; inertia 0.91 kg * 0.41 m/s^2 = 0.37 N
    const double a = i % 1000 < 500 ? 0.4 : -0.4;
    loop.tool_tip = Point<'W'>(0.06 * std::sin(a), 0, kTop - kBallRadius + 0.06 * std::cos(a));
    felt = std::max(felt, loop.tick().force.norm());
  }
  EXPECT_LT(felt, 1e-6);
  EXPECT_GT(loop.worst_acceleration, 0.9);
}

struct Count {
  int leaves = 0;
  template <class T>
  void operator()(std::string_view, T&) {
    ++leaves;
  }
};
template <class Task>
int leaves_of() {
  Count count;
  State state;
  state.task = typename Task::Memory();
  fields(count, state);
  return count.leaves;
}

// The state holds and hashes only the memory of its own task.
TEST(State, ATickHashesWhatItsTaskHas) {
  Count shared;
  State state;
  fields(shared, state);
  for (const int leaves : {leaves_of<AdmittanceTask>(), leaves_of<ImpedanceTask>(),
                           leaves_of<IndentationTask>(), leaves_of<TrackingTask>()}) {
    EXPECT_GT(leaves, shared.leaves);
    EXPECT_LT(leaves, shared.leaves + 125);
  }
  EXPECT_GE(leaves_of<DynamicObjectTask>(), leaves_of<ImpedanceTask>() + 9 * static_cast<int>(kMostMoving));
}

TEST(State, AStateHasTheMemoryOfItsScenesTask) {
  Loop loop(prepare(test::ball_scene(), RigSpec{}));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(loop.state.task));
  EXPECT_EQ(recall<AdmittanceState>(loop.state).contact.object, -1) << "nothing yet";
  loop.tick();
  EXPECT_TRUE(std::holds_alternative<AdmittanceState>(loop.state.task));
  EXPECT_FALSE(recall<ImpedanceState>(loop.state).aim.target.finite()) << "another task's";
  EXPECT_TRUE(recall<CommandState>(loop.state).command.finite()) << "what several tasks share";
}

// A state from another task's scene continues as a new state.
TEST(State, OfAnotherTaskBeginsAnew) {
  Loop loop(prepare(test::ball_scene(), RigSpec{}));
  loop.tick(500);
  EXPECT_TRUE(loop.state.started && loop.out.manipulator.tip.valid());
  loop.state.task.emplace<IndentationState>().phase = ProbePhase::push;
  loop.tick();
  EXPECT_TRUE(std::holds_alternative<AdmittanceState>(loop.state.task));
  EXPECT_TRUE(loop.out.manipulator.tip.valid()) << "it begins where the machine is";
}

TEST(State, ABallsSceneRemembersItsPart) {
  RecordProperty("state_bytes", static_cast<int>(sizeof(State)));
  RecordProperty("of_a_ball", static_cast<int>(remembered<AdmittanceTask>()));
  std::printf(
      "State %zu bytes; of a scene that renders %zu, meets %zu, pushes %zu, probes %zu, travels %zu\n",
      sizeof(State), remembered<AdmittanceTask>(), remembered<ImpedanceTask>(),
      remembered<DynamicObjectTask>(), remembered<IndentationTask>(), remembered<TrackingTask>());
  EXPECT_LT(remembered<AdmittanceTask>(), 1216U);  // 96 bytes belong to the passivity controller
  EXPECT_GT(sizeof(State), remembered<AdmittanceTask>() + 500U) << "what only other tasks need";
}

}  // namespace
}  // namespace enc
