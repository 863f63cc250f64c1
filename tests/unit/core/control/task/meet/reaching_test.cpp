// An arm's loop, step by step: the core alone under a finger and an arm that are where a test puts them.
#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/finger_bench.h"
#include "tests/support/scenes.h"

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
  const Point<'W'> before = bench.loop.out.wanted;
  bench.at(-0.150, 100, 0.050);
  EXPECT_EQ((bench.loop.out.wanted - before).norm(), 0.0);
}

TEST(Reaching, TheTargetGoesToTheProjectionWithinItsLimits) {
  Bench bench("wall");
  bench.at(-0.050, 10);
  const ArmRig& rig = bench.loop.scene.impedance()->rig;
  const double dt = bench.loop.scene.dt;
  Vec3 before = bench.loop.out.wanted.e(), speed = Vec3::Zero();
  for (int i = 0; i < 1000; ++i) {
    const Vec3 now = bench.at(-0.050, 1, 0.030).wanted.e();
    const Vec3 velocity = (now - before) / dt;
    EXPECT_LE(velocity.norm(), rig.speed * 1.001);
    EXPECT_LE((velocity - speed).norm() / dt, rig.acceleration * 1.001) << i;
    before = now;
    speed = velocity;
  }
  EXPECT_NEAR(before.x(), 0.030, 1e-5);
  EXPECT_NEAR(before.z(), 0.0, 1e-9);
}

// A finger that comes obliquely and evenly, seen at 20 Hz and 50 ms late: where the prop is sent long before
// it touches.
Point<'W'> sent_to(const char* foresight, double gap) {
  Bench bench("wall", {"rig.tracker.prediction=\"constant_velocity\"", "rig.tracker.usual_age_ms=110",
                       std::string("rig.tracker.foresight=\"") + foresight + "\""});
  const Vec3 velocity(0.1, 0.0, -0.2);
  const auto finger = [&](double t) {
    return Point<'W'>(Vec3(0.0, 0.0, 0.008) + (t - 0.5) * velocity);
  };  // at 0.5 s
  for (int i = 0; finger(0.001 * i).xyz[2] - 0.008 > gap; ++i)
    i % 50 == 0 ? bench.loop.see(finger(0.001 * (i - 50)), std::chrono::milliseconds(50)) : bench.loop.tick();
  return bench.loop.out.wanted;
}

TEST(Reaching, TheTargetWaitsWhereTheFingerWillTouch) {
  const Point<'W'> before = sent_to("carried_on", 0.010), ahead = sent_to("reach", 0.010);
  EXPECT_LT(before.xyz[0], -0.003);  // under the finger, which has 5 mm to go sideways
  EXPECT_NEAR(ahead.xyz[0], 0.0, 0.001);
  EXPECT_NEAR(ahead.xyz[2], 0.0, 1e-4);
}

TEST(Reaching, ThePropFacesTheSurfaceThatIsBelievedToBeMet) {
  Bench bench("reaching");
  for (int i = 0; i < 5; ++i) bench.loop.tick(Point<'W'>(0.030, 0.060, 0.060));  // aside of the left ball
  const Vec3 facing = (bench.loop.scene.X_WR * bench.loop.out.prop_facing).e();
  EXPECT_LT((facing - Vec3(0.030, 0.0, 0.070).normalized()).norm(), 1e-6);
  for (int i = 0; i < 5; ++i) bench.loop.tick(Point<'W'>(0.0, 0.0, 0.400));
  EXPECT_FALSE(bench.loop.out.prop_facing.finite());  // away: it stays as it is
}

// A block with a groove in place of the wall, and a finger that goes through the groove: from the right wall
// the nearest point leaps to the left one, 12 mm away and more.
trial::FingerLoop over_a_groove() {
  models::Setup setup =
      models::load(tests::source_dir() + "/models/scenes/wall.toml", "",
                   {"rig.tracker.prediction=\"constant_velocity\"", "rig.tracker.measurement_noise_mm=0.01",
                    "rig.tracker.usual_age_ms=20"});
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
    const Aim& now = recall<Meeting>(loop.state).aim;
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
  EXPECT_TRUE(waited);         // the straight way is not free
  EXPECT_LT(outside, 0.6e-3);  // and is not taken
}

TEST(Reaching, AWallIsASpringOfLambdaKp) {
  Bench bench("wall");
  bench.at(-0.050, 10);
  for (const double depth : {0.001, 0.004, 0.009}) {
    bench.press_tip(depth);
    bench.at(depth, 500);
    EXPECT_NEAR(bench.pushed(), 600.0 * depth, 1e-3) << depth;
    EXPECT_NEAR(bench.loop.out.gain, 2.0, 1e-12);
  }
}

// What vision says of the depth does not count, as long as it is within leave_gap of the prop.
TEST(Reaching, APressingFingerIsAsDeepAsItsProp) {
  Bench bench("wall");
  bench.at(0.0005, 10);
  bench.press_tip(0.005);
  for (const double seen : {0.0025, 0.0050, 0.0075}) {
    bench.at(seen, 500);
    EXPECT_NEAR(bench.loop.out.deflection, 0.005, 1e-9) << seen;
    EXPECT_NEAR(bench.pushed(), 3.0, 1e-3) << seen;
  }
  bench.at(0.020);  // behind the prop it cannot be
  EXPECT_NEAR(bench.loop.out.deflection, 0.005, 1e-9);
  bench.at(0.001);
  EXPECT_NEAR(bench.loop.out.deflection, 0.004, 1e-9);
  EXPECT_EQ(bench.at(-0.002).mode, Mode::contact);  // 1 mm deep by then
  EXPECT_EQ(bench.at(-0.010).mode, Mode::follow);
}

// A prop that is pushed back is a touch, though the finger is seen above it; not where it is seen far off.
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

// A finger beside its prop lifts it off the surface: that is one contact, which does not end in every other
// tick.
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
    const bool now = recall<Meeting>(bench.loop.state).aim.triggered;
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
  EXPECT_TRUE(!bench.loop.out.arm_force.finite() || bench.loop.out.arm_force.norm() < 2.0);
  bench.loop.in.arm.value = good;
  EXPECT_EQ(bench.at(0.005).mode, Mode::contact);
  EXPECT_TRUE(bench.loop.out.arm_force.finite());
  EXPECT_NEAR(bench.pushed(), before, 0.05);  // one bad sample is a tick without news, no kick
}

TEST(Reaching, AFingerLostPushesNoLonger) {
  Bench bench("wall");
  bench.at(0.0005, 10);
  bench.press_tip(0.005);
  bench.at(0.005, 200);
  Tick tick;
  tick.dt = from_seconds(bench.loop.scene.dt);
  const Time last = bench.loop.in.tool.t;
  for (int i = 1; i <= 400; ++i) {  // the arm goes on, the finger's last pose gets old
    tick.index = i;
    tick.t = last + i * tick.dt;
    bench.loop.in.arm.t = tick.t;
    step(bench.loop.scene, tick, bench.loop.in, bench.loop.state, bench.loop.out);
  }
  EXPECT_EQ(bench.loop.out.mode, Mode::hold);
  EXPECT_TRUE((bench.loop.out.why & kToolLost) != 0);
  EXPECT_LT((bench.loop.out.arm_force - weight(bench)).norm(), 1e-12);
}

TEST(Reaching, TooMuchIsCutToThePeakAndTold) {
  Bench bench("wall");
  bench.at(0.0005, 10);
  bench.press_tip(0.020);  // 12 N
  bench.at(0.020, 500);
  // Each motor has its own peak; here the second is the first to reach it.
  const Impedance& law = *bench.loop.scene.impedance();
  const PerJoint torque =
      law.arm.torque(law.arm.jacobian(bench.loop.in.arm.value.joints), bench.loop.out.arm_force);
  EXPECT_NEAR(std::abs(torque[1]), 0.129 * 7.47, 1e-9);
  EXPECT_LT(bench.loop.out.felt.norm(), 8.5);
  EXPECT_TRUE((bench.loop.out.why & kOverload) != 0);
}

// The arm was not seen for longer than `stale_ms`, and has fallen 70 mm: it is not thrown back.
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
  EXPECT_LT(bench.loop.out.felt.norm(), 2.0);  // it sets out, with 15 m/s2; thrown back it would be 8.5 N
  EXPECT_LT((bench.loop.out.wanted - Point<'W'>(0, 0, -0.070)).norm(), 1e-3);
}

// One reading that is missed is no loss: what is pressed stays pressed.
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
    greatest_gain = std::max(greatest_gain, bench.loop.out.gain);
  }
  EXPECT_NEAR(greatest_gain, 600.0 / 300.0, 1e-6);  // the floor's over K_p: it is on the board
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
    most =
        std::max(most, (bench.loop.out.wanted - (middle + Vec<'W'>(Vec3(0.020 * way.normalized())))).norm());
  }
  EXPECT_LT(most, 0.5e-3);
}

// The prop that stands for a drum goes along with the finger: its belt is slower by as much.
TEST(Reaching, ARunningSurfaceIsAsFastWhileItsPropMovesAlong) {
  Bench bench("drum");
  EXPECT_EQ(bench.at(-0.150, 10).prop_speed, 0.0);
  double fastest = 0.0;  // of the target on its way; what is left of it when it arrives, the belt takes out
  for (int i = 0; i < 500; ++i) {
    EXPECT_NEAR(bench.at(-0.020, 1, 0.020).prop_speed, 0.050, 0.060) << i;
    fastest = std::max(fastest, recall<Meeting>(bench.loop.state).aim.velocity.norm());
  }
  EXPECT_GT(fastest, 0.100);
  double x = 0.020;
  // Under a finger the prop goes along without haste, and the belt takes out what it is behind: no leap of a
  // picture is felt.
  for (int i = 0; i < 300; ++i) bench.at(0.001, 1, x -= 60e-6);
  for (int i = 0; i < 700; ++i) bench.at(0.001, 1, x += 30e-6);  // 30 mm/s
  EXPECT_NEAR(bench.loop.out.prop_speed, 0.020, 1e-4);
  for (int i = 0; i < 700; ++i) bench.at(0.001, 1, x -= 30e-6);
  EXPECT_NEAR(bench.loop.out.prop_speed, 0.080, 1e-4);
  EXPECT_NEAR(bench.at(0.001, 700, x).prop_speed, 0.050, 1e-4);
  Bench plate("drum", {"prop.kind=\"plate\""});
  EXPECT_EQ(plate.at(-0.020, 500).prop_speed, 0.0);  // it cannot run
}

// From key to key the target hurries where nobody feels it: a key that is touched stays the target.
TEST(Reaching, WhatIsTouchedStaysTheTarget) {
  Bench bench("keypad");
  const double over_key_5 = 0.010;  // y
  for (int i = 0; i < 1000; ++i) bench.loop.tick({0.0, over_key_5, 0.018});
  const std::int32_t key = bench.loop.out.object;
  for (int i = 0; i < 100; ++i) bench.loop.tick({1e-4 * i, over_key_5, 0.006});  // aside, to the next
  EXPECT_EQ(bench.loop.out.mode, Mode::contact);
  EXPECT_EQ(bench.loop.out.object, key);
  EXPECT_EQ(key, 4);  // key_5
}

}  // namespace
}  // namespace enc
