// The ball: figures of sources/ball 4, and its contacts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "sim/bodies/ball_plant.h"

namespace enc::sim {
namespace {

struct Loop {
  double peak = 0.0;  // N
  double in = 0.0;    // J, work done while pressing
  double out = 0.0;   // J, given back
};

// A press from rest to 6 mm and back at a steady speed, 1 kHz, trapezoid rule.
Loop press_and_release(const BallPlant& ball, double speed, BallPlantState s = {}) {
  Loop loop;
  const long count = std::lround(6e-3 / (speed * 1e-3));
  double d = 0.0, force = 0.0;
  for (long i = 1; i <= 2 * count; ++i) {
    const double to = 6e-3 * static_cast<double>(std::min(i, 2 * count - i)) / static_cast<double>(count);
    const double now = ball.step(s, to, 1e-3);
    (i <= count ? loop.in : loop.out) += 0.5 * (now + force) * std::abs(to - d);
    loop.peak = std::max(loop.peak, now);
    d = to;
    force = now;
  }
  return loop;
}

TEST(BallPlant, ElasticForceOfSNominal) {
  constexpr std::array kForce{0.29, 0.97, 1.87, 2.89, 3.94, 4.98, 5.97, 6.90, 7.80, 8.66, 9.50, 10.33};  // N
  const BallPlant ball;
  for (std::size_t i = 0; i < kForce.size(); ++i) {
    const double d = 0.5e-3 * static_cast<double>(i + 1);
    EXPECT_NEAR(ball.elastic(d), kForce[i], 0.005 + 1e-9) << d * 1e3 << " mm";  // printed to 0.01 N
  }
}

TEST(BallPlant, ElasticForceRisesEverywhere) {
  const BallPlant ball;
  double before = ball.elastic(0.0);
  EXPECT_EQ(before, 0.0);
  EXPECT_EQ(ball.elastic(-1e-3), 0.0);
  for (int i = 1; i <= 10000; ++i) {  // up to 10 mm: past the end of the table at 8 mm
    const double now = ball.elastic(i * 1e-6);
    ASSERT_GT(now, before) << i << " um";
    ASSERT_LT(now - before, 0.01) << i << " um: a jump";
    before = now;
  }
}

// Printed: peak 12.0 N, loss 18.9 % (6.5 of 34.5 mJ).
TEST(BallPlant, LoopOfSNominal) {
  const Loop loop = press_and_release(BallPlant(), 4e-3);
  EXPECT_NEAR(loop.peak, 12.0, 0.05);
  EXPECT_NEAR(loop.in, 34.5e-3, 0.05e-3);
  EXPECT_NEAR(loop.in - loop.out, 6.5e-3, 0.05e-3);
  EXPECT_NEAR(1.0 - loop.out / loop.in, 0.189, 0.0015);
}

TEST(BallPlant, LoopsOfTheOtherSets) {
  struct Case {
    const char* name;
    double modulus, pressure, felt_modulus, friction;
    std::array<double, 3> relaxing;
    double loss;
  };
  const std::array cases{
      Case{"S-low loss", 2.77e6, 10e3, 0.20e6, 0.06, {0.04, 0.04, 0.04}, 0.129},
      Case{"S-high loss", 2.30e6, 10e3, 0.20e6, 0.17, {0.08, 0.08, 0.08}, 0.285},
      Case{"S-vented", 3.37e6, 0.0, 0.40e6, 0.10, {0.06, 0.05, 0.05}, 0.188},
      Case{"S-20 kPa", 1.89e6, 20e3, 0.12e6, 0.10, {0.06, 0.05, 0.05}, 0.189},
  };
  for (const Case& c : cases) {
    BallParameters p;
    p.rubber_modulus = c.modulus;
    p.pressure = c.pressure;
    p.felt_modulus = c.felt_modulus;
    p.friction = c.friction;
    p.relaxing = c.relaxing;
    const Loop loop = press_and_release(BallPlant(p), 4e-3);
    EXPECT_NEAR(loop.peak, 12.0, 0.1) << c.name;
    EXPECT_NEAR(1.0 - loop.out / loop.in, c.loss, 0.003) << c.name;
  }
}

// Printed: +5 % from 1 to 20 mm/s, relaxation 5 % in 10 s at 6 mm.
TEST(BallPlant, RateAndRelaxation) {
  const BallPlant ball;
  const double slow = press_and_release(ball, 1e-3).peak;
  const double fast = press_and_release(ball, 20e-3).peak;
  EXPECT_NEAR(fast / slow - 1.0, 0.05, 0.01);
  BallPlantState s;
  double peak = 0.0;
  for (int i = 1; i <= 1500; ++i) peak = ball.step(s, i * 4e-6, 1e-3);
  const double rested = ball.step(s, 6e-3, 10.0);  // one long step: the branches are exact for any dt
  EXPECT_NEAR(1.0 - rested / peak, 0.05, 0.01);
}

// Friction alone, pressed to d from rest: z = 1 - exp(-d / 0.6 mm), F = F_e (1 + 0.1 z), at any speed and in
// any number of steps.
TEST(BallPlant, FrictionAsByHand) {
  BallParameters p{.relaxing = {0.0, 0.0, 0.0}};
  const BallPlant ball(p);
  const double expected = ball.elastic(3e-3) * (1.0 + 0.1 * (1.0 - std::exp(-5.0)));
  BallPlantState once;
  EXPECT_NEAR(ball.step(once, 3e-3, 1.0), expected, 1e-12);
  BallPlantState often;
  double force = 0.0;
  for (int i = 1; i <= 3000; ++i) force = ball.step(often, i * 1e-6, 1e-3);
  EXPECT_NEAR(force, expected, 1e-9);
}

TEST(BallPlant, LiftsOffBeforeZeroAndNeverPulls) {
  const BallPlant ball;
  BallPlantState s;
  for (int i = 1; i <= 1500; ++i) ball.step(s, i * 4e-6, 1e-3);
  int free = 0;
  for (int i = 1499; i >= -50; --i) {
    const double force = ball.step(s, i * 4e-6, 1e-3);
    ASSERT_GE(force, 0.0);
    if (force == 0.0) ++free;
  }
  EXPECT_GT(free, 50);  // free at 0.5 mm already, see the release curve
  EXPECT_EQ(s.deflection, 0.0);
}

// The real ball under the probe: figures of sources/ball 4.

constexpr double kApart = 0.043;  // m, between the centres at the first touch

BallTruth even() {
  BallTruth truth{.uneven = 0.0};
  return truth;
}

BallContact ball_of_set(const BallTruth& truth) { return {truth, Point<'W'>(0, 0, 0), 0.033, 0.010}; }

// A push straight up beside the centre, from the first touch to `depth` at 4 mm/s, and back on request.
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

// Felt friction of 0.6 gives a force between that and a force straight along the push: 10.40 N.
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

// A ball that is pressed and then moved far along the surface slides with mu F_n against its motion; stretch
// <= 1.
TEST(BallContact, SlidesInTheEnd) {
  BallTruth truth = even();
  BallContact ball = ball_of_set(truth);
  push(ball, 0.0, 3e-3);
  for (int i = 1; i <= 2000; ++i) {  // 40 deg around the ball at constant penetration
    const double angle = i * 0.35e-3;
    ball.move(Point<'W'>(0.040 * std::sin(angle), 0, -0.040 * std::cos(angle)), 1e-3);
    ASSERT_LE(ball.state().stretch.norm(), 1.0 + 1e-12);
  }
  const Vec3 n(std::sin(0.7), 0, -std::cos(0.7)), along(std::cos(0.7), 0, std::sin(0.7));
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
    BallTruth truth{.set = c.set};
    BallContact ball = ball_of_set(truth);
    const Push loop = push(ball, 0.0, 6e-3, true);
    EXPECT_GT(loop.peak, c.low) << static_cast<int>(c.set);
    EXPECT_LT(loop.peak, c.high) << static_cast<int>(c.set);
    if (!std::isnan(c.loss)) {
      EXPECT_NEAR(1.0 - loop.out / loop.in, c.loss, 0.01) << static_cast<int>(c.set);
    }
  }
}

// A given number overrides the set, and nothing else changes.
TEST(BallContact, ANumberStandsOverItsSet) {
  BallTruth truth{.set = BallSet::vented, .rubber_modulus = 3.0e6};
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
  BallTruth truth{.uneven = 0.05};
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
