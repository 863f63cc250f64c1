// A machine that a procedure sends from pose to pose, driven by hand.
#include "core/control/carry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace enc {
namespace {

// A scene with [travel], whose jaws hold their tool from tick `grips` on.
struct Sent {
  explicit Sent(int grips = 0) : loop(made()) {
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
    in.tip.value.X_RH = out.tip.valid() ? out.tip : loop.reach.machine.zero();
    in.tip.value.velocity = in.tip.value.acceleration = Vec<'R'>::zero();
    in.tip.t = tick.t;
    in.tip.health = Health::ok;
    carry(loop, tick, in, to, state, out);
  }
  [[nodiscard]] Pose<'W', 'H'> at() const { return loop.X_WR * out.tip; }
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
  Sent sent;
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
  Sent sent(200);
  for (int i = 0; i < 150; ++i) sent.next(kTo);
  EXPECT_LT(sent.at().p().norm(), 1e-9) << "it moved before the tool was held";
  EXPECT_LT(sent.at().q().angularDistance(Quat::Identity()), 1e-12) << "it turned before the tool was held";
  for (int i = 0; i < 500; ++i) sent.next({});
  EXPECT_LT(sent.at().p().norm(), 1e-9) << "it went to the stops of its travel";
  EXPECT_LT(sent.at().q().angularDistance(Quat::Identity()), 1e-12);
  for (int i = 0; i < 500; ++i) sent.next(kTo);
  EXPECT_GT(sent.at().p().norm(), 5e-3);
}

// Turned by a little more in each tick, as whoever turns it slowly asks.
Pose<'W', 'H'> a_little_turned(int i) {
  return {Quat(Eigen::AngleAxisd(1e-4 * i, Vec3::UnitX())), Vec3(kTo.p())};
}

TEST(Carry, JawsThatNoLongerHoldLetItNeitherGoNorTurn) {
  Sent sent;
  for (int i = 1; i <= 100; ++i) sent.next(a_little_turned(i));
  sent.phase = GripPhase::opening;  // which is no hold: a hand may be taking the tool out
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
  Sent sent;
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
  EXPECT_TRUE(sent.out.grip.closed);
}

}  // namespace
}  // namespace enc
