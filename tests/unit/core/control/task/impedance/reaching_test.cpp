// An arm's loop, step by step: the core alone, with a finger and an arm at places that a test sets.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/by_hand.h"
#include "tests/support/scenes.h"
#include "tests/unit/trial/runs.h"

namespace enc {
namespace {

using Bench = test::FingerBench;

// Gravity alone: eq. 4 and 5.
Vec<'R'> weight(const Bench& bench) {
  const Impedance& law = *bench.loop.scene.impedance();
  const PerJoint& q = bench.loop.in.arm.value.joints;
  return law.arm.force(law.arm.jacobian(q), law.arm.gravity(q, law.prop_mass, Payload::exact));
}

TEST(Reaching, AwayFollowContact) {
  Bench bench("wall");
  EXPECT_EQ(bench.at(-0.150).mode, Mode::away);
  EXPECT_EQ(bench.at(-0.110).mode, Mode::away);  // resume_mm = 100
  EXPECT_EQ(bench.at(-0.090).mode, Mode::follow);
  EXPECT_EQ(bench.at(-0.110).mode, Mode::follow);  // pause_mm = 120
  EXPECT_EQ(bench.at(0.001).mode, Mode::contact);
  EXPECT_EQ(bench.at(-0.002).mode, Mode::contact);  // leave_gap_mm = 3, from the prop
  EXPECT_EQ(bench.at(-0.010).mode, Mode::follow);
  EXPECT_EQ(bench.at(-0.130).mode, Mode::away);
  EXPECT_EQ(bench.loop.out.contacts, 1);
}

TEST(Reaching, FarAwayTheTargetStandsStill) {
  Bench bench("wall");
  bench.at(-0.150, 100);
  const Point<'W'> before = bench.loop.out.arm.target;
  bench.at(-0.150, 100, 0.050);
  EXPECT_EQ((bench.loop.out.arm.target - before).norm(), 0.0);
}

TEST(Reaching, TheTargetGoesToTheProjectionWithinItsLimits) {
  Bench bench("wall");
  bench.at(-0.050, 10);
  const ArmRig& rig = bench.loop.scene.impedance()->rig;
  const double dt = bench.loop.scene.dt;
  Vec3 before = bench.loop.out.arm.target.e(), speed = Vec3::Zero();
  for (int i = 0; i < 1000; ++i) {
    const Vec3 now = bench.at(-0.050, 1, 0.030).arm.target.e();
    const Vec3 velocity = (now - before) / dt;
    EXPECT_LE(velocity.norm(), rig.speed * 1.001);
    EXPECT_LE((velocity - speed).norm() / dt, rig.acceleration * 1.001) << i;
    before = now;
    speed = velocity;
  }
  EXPECT_NEAR(before.x(), 0.030, 1e-5);
  EXPECT_NEAR(before.z(), 0.0, 1e-9);
}

// A finger that comes obliquely and evenly, seen at 20 Hz and 50 ms late. Return the place where the prop is
// sent long before the touch.
Point<'W'> sent_to(const char* foresight, double gap) {
  Bench bench("wall", {"rig.tracker.prediction=\"constant_velocity\"", "rig.tracker.usual_age_ms=110",
                       std::string("rig.tracker.foresight=\"") + foresight + "\""});
  const Vec3 velocity(0.1, 0.0, -0.2);
  const auto finger = [&](double t) {
    return Point<'W'>(Vec3(0.0, 0.0, 0.008) + (t - 0.5) * velocity);
  };  // at 0.5 s
  for (int i = 0; finger(0.001 * i).xyz[2] - 0.008 > gap; ++i)
    i % 50 == 0 ? bench.loop.see(finger(0.001 * (i - 50)), std::chrono::milliseconds(50)) : bench.loop.tick();
  return bench.loop.out.arm.target;
}

TEST(Reaching, TheTargetWaitsWhereTheFingerWillTouch) {
  const Point<'W'> before = sent_to("carried_on", 0.010), ahead = sent_to("reach", 0.010);
  EXPECT_LT(before.xyz[0], -0.003);  // under the finger, which has 5 mm to go sideways
  EXPECT_NEAR(ahead.xyz[0], 0.0, 0.001);
  EXPECT_NEAR(ahead.xyz[2], 0.0, 1e-4);
}

TEST(Reaching, ThePropFacesTheSurfaceThatIsBelievedToBeMet) {
  Bench bench("reaching");
  for (int i = 0; i < 5; ++i) bench.loop.tick(Point<'W'>(0.030, 0.060, 0.060));  // beside the left ball
  const Vec3 facing = (bench.loop.scene.X_WR * bench.loop.out.arm.prop_facing).e();
  EXPECT_LT((facing - Vec3(0.030, 0.0, 0.070).normalized()).norm(), 1e-6);
  for (int i = 0; i < 5; ++i) bench.loop.tick(Point<'W'>(0.0, 0.0, 0.400));
  EXPECT_FALSE(bench.loop.out.arm.prop_facing.finite());  // away: it stays as it is
}

// A block with a groove replaces the wall, and the finger goes through the groove. From the right wall the
// nearest point leaps to the left wall, at least 12 mm away.
trial::FingerLoop over_a_groove() {
  models::Setup setup =
      test::shipped("wall", {"rig.tracker.prediction=\"constant_velocity\"",
                             "rig.tracker.measurement_noise_mm=0.01", "rig.tracker.usual_age_ms=20"});
  ObjectSpec& object = setup.scene.objects[0];
  object.shape = ShapeKind::mesh;
  object.surface = std::make_shared<const Mesh>(test::prism({{0.0, -0.06},
                                                             {0.06, -0.06},
                                                             {0.06, 0.0},
                                                             {0.025, 0.0},
                                                             {0.0, -0.035},
                                                             {-0.025, 0.0},
                                                             {-0.06, 0.0},
                                                             {-0.06, -0.06}},
                                                            0.12));
  return trial::FingerLoop(trial::prepare_setup(setup));
}

TEST(Reaching, ATargetThatLeapsKeepsItsLimitsAndWaitsInside) {
  trial::FingerLoop loop = over_a_groove();
  const ArmRig& rig = loop.scene.impedance()->rig;
  const double dt = loop.scene.dt;
  Vec3 before = Vec3::Zero(), speed = Vec3::Zero();
  double outside = -1.0, widest = 0.0;
  bool caught_up = false, waited = false;
  for (int i = 0; i < 6000; ++i) {
    // Down along the right wall until the target is there, then at 50 to 300 mm/s to and fro across the
    // groove.
    const double t = 1e-3 * i;
    const double x = i < 1500 ? 0.008 : 0.008 * std::cos(2.0 * M_PI * (t - 1.5) * (1.0 + (t - 1.5)));
    loop.tick(Point<'W'>(x, 0.0, 0.004));
    const Aim& now = recall<ImpedanceState>(loop.state).aim;
    const Vec3 velocity = (now.target.e() - before) / dt;
    before = now.target.e();
    if (i == 0) speed = now.velocity.e();
    if (i == 0) continue;
    ASSERT_LE(now.velocity.norm(), rig.speed * (1 + 1e-9)) << i;
    ASSERT_LE(velocity.norm(), rig.speed * (1 + 1e-9)) << i;
    const double most = now.hurried ? rig.reach_acceleration : rig.acceleration;
    ASSERT_LE((velocity - speed).norm() / dt, most * (1 + 1e-6)) << i;
    speed = velocity;
    caught_up = caught_up || now.caught_up;
    widest = std::max(widest, std::abs(x));
    if (loop.state.entered) {
      const double out =
          loop.scene.objects[0].surface.nearest(loop.scene.objects[0].X_WO.inverse() * now.target).distance;
      outside = std::max(outside, out);
      waited = waited || (!now.caught_up && now.velocity.norm() < 1e-3);
    }
  }
  EXPECT_TRUE(caught_up);
  EXPECT_TRUE(waited);         // the straight line is blocked
  EXPECT_LT(outside, 0.6e-3);  // and the target does not take it
}

TEST(Reaching, AWallIsASpringOfLambdaKp) {
  Bench bench("wall");
  bench.at(-0.050, 10);
  for (const double depth : {0.001, 0.004, 0.009}) {
    bench.press_tip(depth);
    bench.at(depth, 500);
    EXPECT_NEAR(bench.pushed(), 600.0 * depth, 1e-3) << depth;
    EXPECT_NEAR(bench.loop.out.arm.gain, 2.0, 1e-12);
  }
}

// The depth measured by vision does not count while it is within leave_gap of the prop.
TEST(Reaching, APressingFingerIsAsDeepAsItsProp) {
  Bench bench("wall");
  bench.at(0.0005, 10);
  bench.press_tip(0.005);
  for (const double seen : {0.0025, 0.0050, 0.0075}) {
    bench.at(seen, 500);
    EXPECT_NEAR(bench.loop.out.deflection, 0.005, 1e-9) << seen;
    EXPECT_NEAR(bench.pushed(), 3.0, 1e-3) << seen;
  }
  bench.at(0.020);  // it cannot be behind the prop
  EXPECT_NEAR(bench.loop.out.deflection, 0.005, 1e-9);
  bench.at(0.001);
  EXPECT_NEAR(bench.loop.out.deflection, 0.004, 1e-9);
  EXPECT_EQ(bench.at(-0.002).mode, Mode::contact);  // 1 mm deep by then
  EXPECT_EQ(bench.at(-0.010).mode, Mode::follow);
}

// A prop that is pushed back is a touch, even if vision sees the finger above it, but not if it sees the
// finger far off.
TEST(Reaching, ThePropFeelsATouchBeforeItIsSeen) {
  for (const auto& [gap, mode] : {std::pair{0.002, Mode::contact}, {0.004, Mode::follow}}) {
    Bench bench("wall");
    bench.loop.in.withheld = false;
    bench.at(-gap, 100);
    EXPECT_EQ(bench.loop.out.mode, Mode::follow) << gap;
    bench.press_tip(0.002);
    bench.at(-gap, 100);
    EXPECT_EQ(bench.loop.out.mode, mode) << gap;
  }
}

// A finger beside its prop lifts it off the surface: that is one contact, not one every second tick.
TEST(Reaching, AFingerBehindAPropThatIsLiftedStaysInContact) {
  Bench bench("wall");
  bench.at(-0.001, 100);
  bench.at(0.001, 10);
  bench.press_tip(-0.005);
  bench.at(0.013, 100);
  EXPECT_EQ(bench.loop.out.mode, Mode::contact);
  EXPECT_EQ(bench.loop.out.contacts, 1);
  EXPECT_EQ(bench.loop.out.deflection, 0.0);
}

TEST(Reaching, AButtonClicksOnceOnTheWayIn) {
  Bench bench("button");
  bench.at(-0.020, 200);
  int clicks = 0;
  bool before = false;
  double most = 0.0, last = 0.0;
  for (int i = 0; i <= 6000; ++i) {
    const double depth = 1e-6 * i;
    bench.press_tip(depth);
    bench.at(depth);
    const bool now = recall<ImpedanceState>(bench.loop.state).aim.triggered;
    clicks += now && !before ? 1 : 0;
    before = now;
    most = std::max(most, std::abs(bench.pushed() - last));
    last = bench.pushed();
  }
  EXPECT_EQ(clicks, 1);
  EXPECT_LT(most, 0.02);  // N a tick, at 1 mm/s
  bench.at(0.006, 500);
  EXPECT_NEAR(bench.pushed(), 600.0 * (0.006 - 0.004 * (1.0 - 200.0 / 600.0)), 2e-3);
}

TEST(Reaching, AHoldLeavesGravityAloneAndRecovers) {
  Bench bench("wall");
  bench.at(0.0005, 10);
  bench.press_tip(0.005);
  bench.at(0.005, 200);
  const double before = bench.pushed();
  ASSERT_GT(before, 2.5);
  const ArmSample good = bench.loop.in.arm.value;
  bench.loop.in.arm.value.velocity = Vec<'R'>(kUnset, 0, 0);
  EXPECT_EQ(bench.at(0.005).mode, Mode::hold);
  EXPECT_TRUE((bench.loop.out.why & kTipInvalid) != 0);
  EXPECT_TRUE(!bench.loop.out.arm.force.finite() || bench.loop.out.arm.force.norm() < 2.0);
  bench.loop.in.arm.value = good;
  EXPECT_EQ(bench.at(0.005).mode, Mode::contact);
  EXPECT_TRUE(bench.loop.out.arm.force.finite());
  EXPECT_NEAR(bench.pushed(), before, 0.05);  // one bad sample is a tick without data, not a kick
}

TEST(Reaching, AFingerLostPushesNoLonger) {
  Bench bench("wall");
  bench.at(0.0005, 10);
  bench.press_tip(0.005);
  bench.at(0.005, 200);
  Tick tick{.dt = from_seconds(bench.loop.scene.dt)};
  const Time last = bench.loop.in.tool.t;
  for (int i = 1; i <= 400; ++i) {  // the arm goes on, the finger's last pose ages
    tick.index = i;
    tick.t = last + i * tick.dt;
    bench.loop.in.arm.t = tick.t;
    step(bench.loop.scene, tick, bench.loop.in, bench.loop.state, bench.loop.out);
  }
  EXPECT_EQ(bench.loop.out.mode, Mode::hold);
  EXPECT_TRUE((bench.loop.out.why & kToolLost) != 0);
  EXPECT_LT((bench.loop.out.arm.force - weight(bench)).norm(), 1e-12);
}

TEST(Reaching, TooMuchIsCutToThePeakAndTold) {
  Bench bench("wall");
  bench.at(0.0005, 10);
  bench.press_tip(0.020);  // 12 N
  bench.at(0.020, 500);
  // Each motor has its own peak; here the second is the first to reach it.
  const Impedance& law = *bench.loop.scene.impedance();
  const PerJoint torque =
      law.arm.torque(law.arm.jacobian(bench.loop.in.arm.value.joints), bench.loop.out.arm.force);
  EXPECT_NEAR(std::abs(torque[1]), 0.129 * 7.47, 1e-9);
  EXPECT_LT(bench.loop.out.force_unfiltered.norm(), 8.5);
  EXPECT_TRUE((bench.loop.out.why & kOverload) != 0);
}

// The arm was unseen for longer than `stale_ms` and has fallen 70 mm: the law does not throw it back.
TEST(Reaching, AfterALossItBeginsWhereItIs) {
  Bench bench("wall");
  bench.at(-0.050, 1000);
  const PerJoint before = bench.loop.in.arm.value.joints;
  for (int i = 0; i < 300; ++i) {
    bench.loop.in.arm.value.joints[0] = kUnset;
    bench.at(-0.050);
  }
  bench.loop.in.arm.value.joints = before;
  bench.press_tip(0.070);
  bench.at(-0.050);
  EXPECT_LT(bench.loop.out.force_unfiltered.norm(),
            2.0);  // it starts with 15 m/s2; thrown back it would be 8.5 N
  EXPECT_LT((bench.loop.out.arm.target - Point<'W'>(0, 0, -0.070)).norm(), 1e-3);
}

// One missed reading is no loss: the press continues.
TEST(Reaching, OneBadReadingDropsNothing) {
  Bench bench("wall");
  bench.at(0.005, 500);
  bench.press_tip(0.005);
  bench.at(0.005, 500);
  const double before = bench.pushed();
  const PerJoint joints = bench.loop.in.arm.value.joints;
  bench.loop.in.arm.value.joints[0] = kUnset;
  bench.at(0.005);
  bench.loop.in.arm.value.joints = joints;
  bench.at(0.005);
  EXPECT_NEAR(bench.pushed(), before, 0.01);
}

// [V33]: through the trigger to the bottom board, 2.5 mm/s.
TEST(Reaching, TheChangeToTheBottomBoardDoesNotLeapInForce) {
  Bench bench("button");
  bench.at(0.0, 500);
  double most = 0.0, last = bench.pushed(), greatest_gain = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double depth = 2.5e-6 * i;
    bench.press_tip(depth);
    bench.at(depth);
    most = std::max(most, std::abs(bench.pushed() - last));
    last = bench.pushed();
    greatest_gain = std::max(greatest_gain, bench.loop.out.arm.gain);
  }
  EXPECT_NEAR(greatest_gain, 600.0 / 300.0, 1e-6);  // the floor's stiffness over K_p: it is on the board
  EXPECT_LT(most, 0.2);
}

// Over a ball of 20 mm the projection is slower than the finger that passes by.
TEST(Reaching, TheTargetOverABallStaysUnderTheFinger) {
  Bench bench("reaching", {"rig.tracker.prediction=\"constant_velocity\""});
  const double v = 0.2;  // m/s, along x, 30 mm over the top of the ball `right`
  double most = 0.0;
  for (int i = 0; i < 1200; ++i) {
    const Point<'W'> finger(v * 1e-3 * (i - 1000), -0.060, 0.048);
    bench.loop.tick(finger);
    if (i < 800) continue;
    const Point<'W'> middle(0, -0.060, -0.010);
    const Vec3 way = (finger - middle).e();
    most = std::max(most,
                    (bench.loop.out.arm.target - (middle + Vec<'W'>(Vec3(0.020 * way.normalized())))).norm());
  }
  EXPECT_LT(most, 0.5e-3);
}

// The prop of a drum moves along with the finger: its belt is slower by that speed.
TEST(Reaching, ARunningSurfaceIsAsFastWhileItsPropMovesAlong) {
  Bench bench("drum");
  EXPECT_EQ(bench.at(-0.150, 10).arm.prop_speed, 0.0);
  double fastest = 0.0;  // speed of the target on its way; the belt removes the rest on arrival
  for (int i = 0; i < 500; ++i) {
    EXPECT_NEAR(bench.at(-0.020, 1, 0.020).arm.prop_speed, 0.050, 0.060) << i;
    fastest = std::max(fastest, recall<ImpedanceState>(bench.loop.state).aim.velocity.norm());
  }
  EXPECT_GT(fastest, 0.100);
  double x = 0.020;
  // Under a finger the prop moves along without haste, and the belt removes its lag: a leap of a picture is
  // not felt.
  for (int i = 0; i < 300; ++i) bench.at(0.001, 1, x -= 60e-6);
  for (int i = 0; i < 700; ++i) bench.at(0.001, 1, x += 30e-6);  // 30 mm/s
  EXPECT_NEAR(bench.loop.out.arm.prop_speed, 0.020, 1e-4);
  for (int i = 0; i < 700; ++i) bench.at(0.001, 1, x -= 30e-6);
  EXPECT_NEAR(bench.loop.out.arm.prop_speed, 0.080, 1e-4);
  EXPECT_NEAR(bench.at(0.001, 700, x).arm.prop_speed, 0.050, 1e-4);
  Bench plate("drum", {"prop.kind=\"plate\""});
  EXPECT_EQ(plate.at(-0.020, 500).arm.prop_speed, 0.0);  // it cannot run
}

// The target moves fast from key to key only without a touch: a touched key stays the target.
TEST(Reaching, WhatIsTouchedStaysTheTarget) {
  Bench bench("keypad");
  const double over_key_5 = 0.010;  // y
  for (int i = 0; i < 1000; ++i) bench.loop.tick({0.0, over_key_5, 0.018});
  const std::int32_t key = bench.loop.out.object;
  for (int i = 0; i < 100; ++i) bench.loop.tick({1e-4 * i, over_key_5, 0.006});  // aside, to the next key
  EXPECT_EQ(bench.loop.out.mode, Mode::contact);
  EXPECT_EQ(bench.loop.out.object, key);
  EXPECT_EQ(key, 4);  // key_5
}

// The arm meets a coming finger at its place of touch, in haste, if pictures can show that. An arm at rest
// afterwards does not push. Core alone; the test sets finger and arm.

using Bench = test::FingerBench;

// A finger that is at z = `gap` above the wall at 0.5 s, seen at 20 Hz and 50 ms late.
struct ApproachingFinger {
  Vec3 velocity{0.1, 0.0, -0.2};
  double gap = 0.0;
  [[nodiscard]] Point<'W'> at(double t) const {
    return Point<'W'>(Vec3(0.0, 0.0, 0.008 + gap) + (t - 0.5) * velocity);
  }
};

struct ReachTrace {
  Point<'W'> wanted;                    // last place where the prop is sent
  double hurried = 0.0, without = 0.0;  // m/s^2: largest of the target
  double predicted_way = 0.0;           // m: from the foreseen place to the finger's projection
};

ReachTrace meet(const ApproachingFinger& finger, double until, const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{"rig.tracker.prediction=\"constant_velocity\"",
                               "rig.tracker.usual_age_ms=110"};
  set.insert(set.end(), more.begin(), more.end());
  Bench bench("wall", set);
  ReachTrace gone;
  const double dt = bench.loop.scene.dt;
  Vec3 before = Vec3::Zero();
  for (int i = 0; 0.001 * i < until; ++i) {
    i % 50 == 0 ? bench.loop.see(finger.at(0.001 * (i - 50)), std::chrono::milliseconds(50))
                : bench.loop.tick();
    const Aim& now = recall<ImpedanceState>(bench.loop.state).aim;
    const double change = (now.velocity.e() - before).norm() / dt;
    before = now.velocity.e();
    double& most = now.hurried ? gone.hurried : gone.without;
    most = std::max(most, change);
  }
  gone.wanted = bench.loop.out.arm.target;
  gone.predicted_way = (gone.wanted.e() - finger.at(until).e()).head<2>().norm();
  return gone;
}

TEST(ReachPrediction, PicturesThatAreTooVagueForeseeNothing) {
  const auto with_noise = [](double noise, double vaguest) {
    return meet({}, 0.45,
                {fmt::format("rig.tracker.measurement_noise_mm={}", noise),
                 fmt::format("rig.tracker.reach.vaguest_mm={}", vaguest)})
        .wanted.xyz[0];
  };
  EXPECT_NEAR(with_noise(0.5, 1.1), 0.0, 1e-3);     // it will touch at x = 0
  EXPECT_NEAR(with_noise(1.2, 1.1), -0.005, 1e-3);  // it is at x = -5 mm
  EXPECT_GT(with_noise(1.2, 1.3), -0.004);
}

// x where the prop is sent, m, if picture i of the finger states this sigma; below 0: none stated.
double sent_x(const std::function<double(int)>& vague) {
  Bench bench("wall", {"rig.tracker.prediction=\"constant_velocity\"", "rig.tracker.usual_age_ms=110"});
  for (int i = 0; i < 450; ++i) {
    const double noise = vague(i / 50);
    if (i % 50 != 0 || noise < 0.0) {
      bench.loop.tick();
      continue;
    }
    bench.loop.put(ApproachingFinger{}.at(0.001 * (i - 50)));
    bench.loop.in.tool.t -= std::chrono::milliseconds(50);
    TrackedTool& seen = bench.loop.in.tool.value;
    seen.along = seen.across = noise;
    bench.loop.go();
  }
  return bench.loop.out.arm.target.xyz[0];
}
double sent_x(double even, double odd) {
  return sent_x([&](int i) { return i % 2 == 0 ? even : odd; });
}

// The sigma that a picture states counts, and not the rig's figure.
TEST(ReachPrediction, HowVagueAPictureIsItSaysItself) {
  for (const auto& [noise, x] : {std::pair{0.5e-3, 0.0}, {1.5e-3, -0.005}, {kUnset, 0.0}})
    EXPECT_NEAR(sent_x(noise, noise), x, 1e-3) << noise;
}

TEST(ReachPrediction, WhatIsAboutAsVagueAsMayBeIsNotAskedNowAndThen) {
  // The last of them, at 400 ms, is an even one.
  EXPECT_NEAR(sent_x(1.15e-3, 1.05e-3), 0.0, 1e-3);
  EXPECT_LT(sent_x(1.25e-3, 1.05e-3), -0.003) << "on its way back";
  EXPECT_NEAR(sent_x(1.15e-3, 1.15e-3), -0.005, 1e-3);
}

TEST(ReachPrediction, HowClearOldPicturesWereIsForgottenWithThem) {
  const auto from = [](int first, double then) {  // the new ones, after 50 ms times `first`
    return sent_x([&, then](int i) { return i < 2 ? 1.05e-3 : i < first ? -1.0 : then; });
  };
  EXPECT_NEAR(from(4, 1.15e-3), 0.0, 1e-3) << "the same finger, seen on";
  EXPECT_NEAR(from(6, 1.05e-3), 0.0, 1e-3);
  EXPECT_NEAR(from(6, 1.15e-3), -0.005, 1e-3) << "unseen for longer than it is believed to go on";
}

TEST(ReachPrediction, AFingerThatHoversIsMetUnderWhereItIs) {
  const ApproachingFinger hovers{{0.1, 0.0, -0.04}, 0.020};
  EXPECT_LT(meet(hovers, 0.5).predicted_way, 1.5e-3);
  const ApproachingFinger comes{{0.1, 0.0, -0.2}, 0.020};  // 100 ms and 10 mm further
  EXPECT_GT(meet(comes, 0.5).predicted_way, 5e-3);
}

TEST(ReachPrediction, OnlyToWhereAReachMayTouchTheTargetHurries) {
  Bench bench("wall");
  const ArmRig& rig = bench.loop.scene.impedance()->rig;
  ASSERT_LT(rig.acceleration, rig.reach_acceleration);
  const ReachTrace reach = meet({}, 0.45);
  EXPECT_GT(reach.hurried, rig.acceleration * 1.1);
  EXPECT_LE(reach.hurried, rig.reach_acceleration * 1.001);
  EXPECT_LE(reach.without, rig.acceleration * 1.001);
  for (const ReachTrace& gone :
       {meet({}, 0.45, {"rig.tracker.foresight=\"carried_on\""}), meet({{0.1, 0.0, -0.04}, 0.020}, 0.5)}) {
    EXPECT_EQ(gone.hurried, 0.0);
    EXPECT_LE(gone.without, rig.acceleration * 1.001);
  }
}

// x of the key that a prop is sent to, 0.13 s before a finger that comes obliquely touches at x = 0.
double key_x(const char* foresight) {
  Bench bench("keypad", {"rig.tracker.prediction=\"constant_velocity\"", "rig.tracker.usual_age_ms=110",
                         fmt::format("rig.tracker.foresight=\"{}\"", foresight)});
  const double y = bench.loop.scene.objects[0].X_WO.origin().xyz[1];
  const ApproachingFinger finger{{0.2, 0.0, -0.2}, 0.0};
  for (int i = 0; i < 370; ++i) {
    const Point<'W'> at = finger.at(0.001 * (i - 50)) + Vec<'W'>(0.0, y, 0.0);
    i % 50 == 0 ? bench.loop.see(at, std::chrono::milliseconds(50)) : bench.loop.tick();
  }
  return bench.loop.scene.objects[static_cast<std::size_t>(bench.loop.out.object)].X_WO.origin().xyz[0];
}

TEST(ReachPrediction, AKeyIsChosenByWhereTheFingerWillTouch) {
  EXPECT_NEAR(key_x("reach"), 0.0, 1e-9);
  EXPECT_NEAR(key_x("carried_on"), -0.020, 1e-9) << "by where it is in 60 ms";
}

// The target brakes the motion that haste began: if the finger stops, the target overshoots by no more than
// its braking distance.
TEST(ReachPrediction, HasteBrakesWhatItSetInMotion) {
  Bench bench("wall", {"rig.tracker.prediction=\"constant_velocity\"", "rig.tracker.usual_age_ms=110"});
  const ArmRig& rig = bench.loop.scene.impedance()->rig;
  const ApproachingFinger finger{{0.3, 0.0, -0.3}, 0.0};
  double braked = 0.0, slow = 0.0;
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 700; ++i) {
    const double t = std::min(0.001 * (i - 50), 0.40);  // it stops in the air
    i % 50 == 0 ? bench.loop.see(finger.at(t), std::chrono::milliseconds(50)) : bench.loop.tick();
    const Aim& now = recall<ImpedanceState>(bench.loop.state).aim;
    const double change = (now.velocity.norm() - before.norm()) / bench.loop.scene.dt;
    before = now.velocity.e();
    double& most = now.hurried ? braked : slow;
    most = std::min(most, change);
  }
  EXPECT_LT(braked, -1.1 * rig.acceleration);
  EXPECT_GE(braked, -1.001 * rig.reach_acceleration);
  EXPECT_GE(slow, -1.001 * rig.acceleration);
}

// The tip is 2 mm from its target when the finger has gone: friction holds it.
double pushed_after_rest(const std::vector<std::string>& set, bool slips = false) {
  Bench bench("wall", set);
  bench.at(-0.050, 50);
  bench.press_tip(0.002);
  bench.at(-0.050, 200);
  EXPECT_NEAR(bench.pushed(), 0.6, 0.01);
  bench.at(-0.150, 1);
  const double soon = bench.pushed();
  EXPECT_GT(soon, 0.5);  // nothing leaps
  if (slips) {           // slip of 0.2 mm, at the speed that one count implies
    bench.press_tip(0.0022);
    bench.loop.in.arm.value.velocity = Vec<'R'>(Vec3(0.0, 0.0, -0.014));
    bench.at(-0.150, 1);
    bench.loop.in.arm.value.velocity = Vec<'R'>::zero();
  }
  bench.at(-0.150, 1000);
  EXPECT_LE(bench.pushed(), std::max(soon, 0.7));
  return bench.pushed();
}

TEST(ReachPrediction, WhatPushesAnArmThatRestsFades) {
  Bench bench("wall");
  for (int again = 0; again < 2; ++again) {  // also after a slip, when a finger has come and gone
    bench.press_tip(0.002);
    bench.at(-0.050, 200);
    int ticks = 0;
    while (!recall<ImpedanceState>(bench.loop.state).aim.stood.finite() && ++ticks < 100) bench.at(-0.150, 1);
    const double before = bench.pushed();
    EXPECT_GT(before, 0.55) << ticks;
    bench.at(-0.150, 50);
    EXPECT_NEAR(bench.pushed(), before * std::exp(-1.0), 0.02 * before);
    bench.press_tip(0.0025);
    bench.at(-0.150, 500);
    EXPECT_NEAR(bench.pushed(), 0.75, 0.02);
  }
  EXPECT_NEAR(pushed_after_rest({}), 0.0, 1e-6);
  EXPECT_NEAR(pushed_after_rest({}, true), 0.66, 0.01) << "it slipped: friction does not hold it alone";
  EXPECT_NEAR(pushed_after_rest({"rig.arm.gravity=\"published\""}), 0.6, 0.01) << "it may hold a weight";
}

}  // namespace
}  // namespace enc
