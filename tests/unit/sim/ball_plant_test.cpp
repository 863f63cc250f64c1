// Figures of sources/ball 4.
#include "sim/bodies/ball_plant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

namespace enc::sim {
namespace {

struct Loop {
  double peak = 0.0;  // N
  double in = 0.0;    // J, work done while pressing
  double out = 0.0;   // J, given back
};

// From rest to 6 mm and back at a steady speed, 1 kHz, trapezoid rule.
Loop press_and_release(const BallPlant& ball, double speed, BallPlantState s = {}) {
  Loop loop;
  const long count = std::lround(6e-3 / (speed * 1e-3));
  double d = 0.0;
  double force = 0.0;
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
  for (int i = 1; i <= 10000; ++i) {  // to 10 mm: past the end of the table at 8 mm
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

// Friction alone, pressed to d from rest: z = 1 - exp(-d / 0.6 mm), F = F_e (1 + 0.1 z), however fast and in
// however many steps.
TEST(BallPlant, FrictionAsByHand) {
  BallParameters p;
  p.relaxing = {0.0, 0.0, 0.0};
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
  EXPECT_GT(free, 50);  // at 0.5 mm already, see the release curve
  EXPECT_EQ(s.deflection, 0.0);
}

}  // namespace
}  // namespace enc::sim
