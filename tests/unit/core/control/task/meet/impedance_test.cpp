// The control law of an arm, piece by piece [VisHap eq. 2, 3, 6, 7; Fig 4].
#include "core/control/task/meet/impedance.h"

#include <complex>
#include <numbers>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "core/base/rotation.h"

namespace enc {
namespace {

TEST(LowPass, IsTheFormulaOfThePaper) {
  std::mt19937_64 draw(3);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  for (const double a : {1e-3, 0.1, 0.75, 5.0}) {
    double y = 0.0;
    double wanted = 0.0;
    for (int i = 0; i < 10000; ++i) {
      const double x = even(draw);
      y = low_pass(a, x, y);
      wanted = wanted / (1.0 + a) + x * (a / (1.0 + a));
      ASSERT_NEAR(y, wanted, 1e-12);
    }
  }
}

// Amplitude of the answer to a sine, by correlation over whole periods.
double gain_at(double a, double hz, double dt) {
  const auto ticks = static_cast<int>(std::lround(200.0 / (hz * dt)));
  double y = 0.0;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < 2 * ticks; ++i) {
    const double angle = 2.0 * std::numbers::pi * hz * dt * i;
    y = low_pass(a, std::sin(angle), y);
    if (i >= ticks) sum += y * std::exp(std::complex<double>(0.0, -angle));
  }
  return 2.0 * std::abs(sum) / ticks;
}

TEST(LowPass, MinusThreeDecibelsWhereItSays) {
  constexpr double dt = 1e-3;
  for (const double hz : {5.0, 20.0, 120.0}) {
    const double a = 2.0 * std::numbers::pi * hz * dt;
    const double corner = corner_frequency(a, dt);
    EXPECT_NEAR(gain_at(a, corner, dt), std::numbers::sqrt2 / 2.0, 2e-3) << hz;
    // The s-domain corner is what the discrete one tends to: 20 Hz at 1 kHz is 2 % lower or so.
    EXPECT_LT(std::abs(corner / hz - 1.0), 0.6 * a) << hz;
  }
  EXPECT_NEAR(corner_frequency(2.0 * std::numbers::pi * 1.0 * 1e-6, 1e-6), 1.0, 1e-5);
}

TEST(GainMatrix, IsSymmetricAndKeepsItsEigenvalues) {
  std::mt19937_64 draw(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const Quat q = Quat(normal(draw), normal(draw), normal(draw), normal(draw)).normalized();
    const Mat3 R = q.toRotationMatrix();
    const double along = 0.1 + 5.0 * std::abs(normal(draw));
    const Mat3 wanted = R * Vec3(1.0, 1.0, along).asDiagonal() * R.transpose();  // eq. 7
    const Mat3 gain = gain_matrix(R.col(2), 1.0, along);
    EXPECT_LT((gain - wanted).norm(), 1e-12);
    EXPECT_LT((gain - gain.transpose()).norm(), 1e-12);
    Vec3 eigen = Eigen::SelfAdjointEigenSolver<Mat3>(gain).eigenvalues();
    Vec3 given(1.0, 1.0, along);
    std::sort(given.data(), given.data() + 3);
    EXPECT_LT((eigen - given).norm(), 1e-12);
  }
}

InteractionSpec button() {
  InteractionSpec spec;
  spec.kind = Interaction::click;
  spec.trigger = 2e-3;
  spec.bottom = 4e-3;
  spec.after = 200.0;
  spec.floor = 600.0;
  spec.gradual = 0.5e-3;
  return spec;
}

double force_at(const InteractionSpec& spec, double stiffness, double depth) {
  const Felt felt = felt_at(spec, stiffness, 300.0, depth);
  return felt.stiffness * (depth - felt.sunk);
}

TEST(FeltAt, WallIsASpringBeyondItsFirstHalfMillimetre) {
  InteractionSpec wall;
  wall.kind = Interaction::slide;
  wall.gradual = 0.5e-3;
  EXPECT_DOUBLE_EQ(felt_at(wall, 600.0, 300.0, 0.0).stiffness, 300.0);  // K_p: what is felt in free space
  EXPECT_DOUBLE_EQ(felt_at(wall, 600.0, 300.0, 0.5e-3).stiffness, 600.0);
  EXPECT_DOUBLE_EQ(felt_at(wall, 600.0, 300.0, 8e-3).stiffness, 600.0);
}

TEST(FeltAt, ButtonHasThreeSlopes) {
  const InteractionSpec spec = button();
  const auto slope = [&](double depth) {
    return (force_at(spec, 400.0, depth + 1e-6) - force_at(spec, 400.0, depth - 1e-6)) / 2e-6;
  };
  EXPECT_NEAR(slope(1.5e-3), 400.0, 1e-6);
  EXPECT_NEAR(slope(3.5e-3), 200.0, 1e-6);
  EXPECT_NEAR(slope(5.0e-3), 600.0, 1e-6);
  EXPECT_NEAR(force_at(spec, 400.0, 2e-3), 0.8, 1e-9);
  EXPECT_NEAR(force_at(spec, 400.0, 2.5e-3), 0.5, 1e-9);  // the click
  EXPECT_NEAR(force_at(spec, 400.0, 4e-3), 0.8, 1e-9);    // where the bottom takes over, without a leap
}

TEST(FeltAt, ForceIsContinuousAtEveryDepth) {
  const InteractionSpec spec = button();
  for (double depth = 0.0; depth < 8e-3; depth += 1e-6)
    EXPECT_LT(std::abs(force_at(spec, 400.0, depth + 1e-6) - force_at(spec, 400.0, depth)), 3e-3) << depth;
}

TEST(FeltAt, AtOnceLeapsWhereItTriggers) {
  InteractionSpec spec = button();
  spec.gradual = 0.0;
  EXPECT_NEAR(force_at(spec, 400.0, 2e-3 - 1e-9) - force_at(spec, 400.0, 2e-3), 0.4, 1e-5);
  EXPECT_NEAR(force_at(spec, 400.0, 4e-3 - 1e-9) - force_at(spec, 400.0, 4e-3), 0.0, 1e-5);
}

}  // namespace
}  // namespace enc
