// A ball that an arm's prop stands for, and that the finger hits.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/finger_bench.h"

namespace enc {
namespace {

using Bench = test::FingerBench;

// A ball, its prop at home, and a finger that is believed wherever a test says.
struct Ball : Bench {
  Ball() : Bench("hit_ball", {"rig.tracker.prediction=\"hold\""}) {
    at(-0.080, 10);
    at(-0.010, 500);
  }
  [[nodiscard]] const Moved& moved() const { return moved_in(loop.state)[0]; }
  // The prop goes on at `speed` under the finger, until they part or for `ticks`.
  int strike(double speed, int ticks = 100) {
    for (int i = 1; i <= ticks; ++i) {
      press_tip(speed * 1e-3 * i);
      loop.in.arm.value.velocity = Vec<'R'>(0, 0, -speed);
      at(-0.002);
      if (i > 10 && loop.out.mode != Mode::contact) return i;
    }
    return ticks;
  }
};

// A picture is 50 ms old, and a hit is over by then.
TEST(HitBall, IsHitByThePropAndNotByWhatIsBelieved) {
  Ball ball;
  ball.at(0.010, 200);
  EXPECT_EQ(ball.loop.out.contacts, 0);
  EXPECT_EQ(ball.moved().velocity.norm(), 0.0) << "the prop was not touched";
  Ball struck;
  const int ticks = struck.strike(0.2);
  EXPECT_EQ(struck.loop.out.contacts, 1);
  EXPECT_LT(ticks, 45);
  EXPECT_NEAR(struck.moved().velocity.norm(), 0.2 * (1.0 + 0.95 * 0.75), 0.02);
  struck.strike(0.2);
  EXPECT_EQ(struck.loop.out.contacts, 1) << "a ball that flies is not hit again";
}

// Two counts and one reading of 0.8 m/s: the prop does not run off with it.
TEST(HitBall, OneWrongReadingSetsNothingInMotion) {
  Ball ball;
  ball.press_tip(0.08e-3);
  ball.loop.in.arm.value.velocity = Vec<'R'>(0, 0, -0.8);
  ball.at(-0.002);
  EXPECT_EQ(ball.loop.out.mode, Mode::contact);
  ball.loop.in.arm.value.velocity = Vec<'R'>::zero();
  double fastest = 0.0;
  for (int i = 0; i < 100; ++i) {
    ball.at(-0.002);
    fastest = std::max(fastest, recall<Meeting>(ball.loop.state).aim.velocity.norm());
  }
  EXPECT_LT(fastest, 0.050);
}

// What the arm is told along the normal is what the ball gets.
TEST(HitBall, ItsMomentumIsTheImpulseOfWhatTheArmIsTold) {
  Ball ball;
  double impulse = 0.0;
  for (int i = 1; i <= 60; ++i) {
    ball.press_tip(0.2e-3 * i);
    ball.loop.in.arm.value.velocity = Vec<'R'>(0, 0, -0.2);
    ball.at(-0.002);
    if (ball.loop.out.mode == Mode::contact) impulse += 1e-3 * ball.pushed();
  }
  EXPECT_GT(impulse, 0.01);
  EXPECT_NEAR(impulse, 0.058 * ball.moved().velocity.norm(), 0.02 * impulse);
}

}  // namespace
}  // namespace enc
