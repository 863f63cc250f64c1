// The real ball under the probe: figures of sources/ball 4.
#include "sim/bodies/ball_contact.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc::sim {
namespace {

constexpr double kApart = 0.043;  // m, of the centres at the first touch

BallTruth even() {
  BallTruth truth;
  truth.uneven = 0.0;
  return truth;
}

BallContact ball_of_set(const BallTruth& truth) { return {truth, Point<'W'>(0, 0, 0), 0.033, 0.010}; }

// Straight up beside the centre, from the first touch to `depth` at 4 mm/s, and back if wanted.
struct Push {
  double peak = 0.0, in = 0.0, out = 0.0;  // N, J along z
};
Push push(BallContact& ball, double offset, double depth, bool back = false) {
  const double from = -std::sqrt(kApart * kApart - offset * offset);
  const long count = std::lround(depth / 4e-6);
  Push result;
  double force = 0.0;
  ball.move(Point<'W'>(offset, 0, from), 1e-3);
  for (long i = 1; i <= (back ? 2 * count : count); ++i) {
    const double at = depth * static_cast<double>(std::min(i, 2 * count - i)) / static_cast<double>(count);
    ball.move(Point<'W'>(offset, 0, from + at), 1e-3);
    const double now = -ball.state().force.xyz[2];
    (i <= count ? result.in : result.out) += 0.5 * (now + force) * 4e-6;
    result.peak = std::max(result.peak, now);
    force = now;
  }
  return result;
}

TEST(BallContact, RadialPushIsThePlantItself) {
  BallContact ball = ball_of_set({});  // uneven, but not on its axis
  const BallPlant plant;
  BallPlantState state;
  plant.step(state, 0.0, 1e-3);
  for (int i = 1; i <= 1500; ++i) {
    ball.move(Point<'W'>(0, 0, -kApart + i * 4e-6), 1e-3);
    const double expected = plant.step(state, i * 4e-6, 1e-3);
    ASSERT_NEAR(ball.state().force.xyz[2], -expected, 1e-9) << i;
    ASSERT_NEAR(ball.state().penetration, i * 4e-6, 1e-12);
    ASSERT_EQ(ball.state().force.xyz[0], 0.0);
  }
  EXPECT_NEAR(ball.state().touched.xyz[2], -kApart + 6e-3 + 0.010, 1e-12);
}

TEST(BallContact, FreeProbeFeelsNothing) {
  BallContact ball = ball_of_set({});
  ball.move(Point<'W'>(0, 0, -0.050), 1e-3);
  EXPECT_EQ(ball.state().force.norm(), 0.0);
  EXPECT_NEAR(ball.state().penetration, -0.007, 1e-12);
}

// Indentation B without friction: the force is along the line of the centres, at rest.
TEST(BallContact, BesideTheCentreTheForceIsAtASlant) {
  BallTruth truth = even();
  truth.surface_friction = 0.0;
  truth.friction = 0.0;
  truth.relaxing = {0.0, 0.0, 0.0};
  BallContact ball = ball_of_set(truth);
  push(ball, 0.010, 0.02e-3);
  const Vec3 early = ball.state().force.e().normalized();
  EXPECT_NEAR(std::asin(early.x()) * 180.0 / M_PI, std::asin(10.0 / 43.0) * 180.0 / M_PI, 0.01);
  BallContact deep = ball_of_set(truth);
  push(deep, 0.010, 6e-3);
  const Vec3 force = deep.state().force.e();
  EXPECT_NEAR(deep.state().penetration, 5.81e-3, 0.01e-3);
  EXPECT_NEAR(std::asin(force.normalized().x()) * 180.0 / M_PI, 15.6, 0.1);
  EXPECT_NEAR(-force.z(), 9.65, 0.02);
  EXPECT_NEAR(force.x(), 2.7, 0.05);
}

// With felt friction of 0.6 between there and a force that is straight along the push: 10.40 N.
TEST(BallContact, FrictionTakesSomeOfTheSlantAway) {
  BallTruth truth = even();
  truth.friction = 0.0;
  truth.relaxing = {0.0, 0.0, 0.0};
  BallContact ball = ball_of_set(truth);
  push(ball, 0.010, 6e-3);
  const Vec3 force = ball.state().force.e();
  EXPECT_GT(-force.z(), 9.65);
  EXPECT_LT(-force.z(), 10.40 + 0.01);
  EXPECT_LT(std::abs(force.x()), 2.7);
  EXPECT_GE(force.x(), -0.01);  // never beyond straight
}

// Pressed and then moved far along the surface, it slides with mu F_n against the way; stretch stays
// within 1.
TEST(BallContact, SlidesInTheEnd) {
  BallTruth truth = even();
  BallContact ball = ball_of_set(truth);
  push(ball, 0.0, 3e-3);
  for (int i = 1; i <= 2000; ++i) {  // 40 deg around the ball at constant penetration
    const double angle = i * 0.35e-3;
    ball.move(Point<'W'>(0.040 * std::sin(angle), 0, -0.040 * std::cos(angle)), 1e-3);
    ASSERT_LE(ball.state().stretch.norm(), 1.0 + 1e-12);
  }
  const Vec3 n(std::sin(0.7), 0, -std::cos(0.7));
  const Vec3 along(std::cos(0.7), 0, std::sin(0.7));
  const Vec3 force = ball.state().force.e();
  EXPECT_NEAR(force.dot(along) / force.dot(n), -0.6, 0.01);
}

TEST(BallContact, SetsGiveWhatTheirTableSays) {
  struct Case {
    BallSet set;
    double low, high, loss;
  };
  for (const Case& c :
       {Case{BallSet::nominal, 11.8, 12.2, 0.189}, Case{BallSet::low_loss, 11.8, 12.2, 0.129},
        Case{BallSet::high_loss, 11.8, 12.2, 0.285}, Case{BallSet::vented, 11.8, 12.2, 0.188},
        Case{BallSet::kpa_20, 11.8, 12.2, 0.189}, Case{BallSet::regulation, 45.0, 52.0, kUnset}}) {
    BallTruth truth;
    truth.set = c.set;
    BallContact ball = ball_of_set(truth);
    const Push loop = push(ball, 0.0, 6e-3, true);
    EXPECT_GT(loop.peak, c.low) << static_cast<int>(c.set);
    EXPECT_LT(loop.peak, c.high) << static_cast<int>(c.set);
    if (!std::isnan(c.loss)) {
      EXPECT_NEAR(1.0 - loop.out / loop.in, c.loss, 0.01) << static_cast<int>(c.set);
    }
  }
}

// What is given stands over the set, and nothing else changes.
TEST(BallContact, ANumberStandsOverItsSet) {
  BallTruth truth;
  truth.set = BallSet::vented;
  truth.rubber_modulus = 3.0e6;
  truth.relaxing[1] = 0.2;
  truth.radius = 0.034;
  const BallParameters ball = ball_of(truth, 0.033);
  const BallParameters set = ball_set(BallSet::vented);
  EXPECT_EQ(ball.rubber_modulus, 3.0e6);
  EXPECT_EQ(ball.relaxing[1], 0.2);
  EXPECT_EQ(ball.relaxing[0], set.relaxing[0]);
  EXPECT_EQ(ball.felt_modulus, set.felt_modulus);
  EXPECT_EQ(ball.outer_radius, 0.034);
  EXPECT_EQ(ball_of({}, 0.033).outer_radius, 0.033);
}

// Radially, 10 deg beside the axis (C): stiffer by `uneven`, all but a thirtieth of it.
TEST(BallContact, UnevenBallIsStifferBesideItsAxis) {
  BallTruth truth;
  truth.uneven = 0.05;
  const double angle = 10.0 * M_PI / 180.0;
  const Vec3 out(std::sin(angle), 0, -std::cos(angle));
  BallContact uneven = ball_of_set(truth);
  BallContact smooth = ball_of_set(even());
  for (int i = 0; i <= 1500; ++i)
    for (BallContact* ball : {&uneven, &smooth})
      ball->move(Point<'W'>(Vec3((kApart - i * 4e-6) * out)), 1e-3);
  EXPECT_NEAR(uneven.state().force.norm() / smooth.state().force.norm(), 1.05, 0.05 / 30);
}

TEST(BallContact, RefusesAProbeThatItsLawDoesNotHoldFor) {
  EXPECT_THROW(BallContact({}, Point<'W'>(0, 0, 0), 0.033, 0.009), Error);
}

}  // namespace
}  // namespace enc::sim
