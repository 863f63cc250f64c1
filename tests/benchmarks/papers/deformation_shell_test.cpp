// The pressed ball of the reference: its energy, states whose answer is known, and the limit of thin shells.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "benchmarks/deformation/shell_energy.h"
#include "benchmarks/deformation/shell_press.h"

namespace enc::bench::deformation {
namespace {

sim::BallParameters ball_at(double pressure) {
  sim::BallParameters ball;
  ball.pressure = pressure;
  return ball;
}

TEST(Shell, GradientAndHessianAreThoseOfTheEnergy) {
  const sim::BallParameters ball = ball_at(50e3);
  ShellEnergy energy(ball, shell_mesh(ball, 2, 2e-3));
  energy.press(1.5e-3);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::VectorXd x = energy.inflated();
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += 30e-6 * uniform(random);
  const ShellEnergy::Value here = energy.at(x);
  ASSERT_TRUE(std::isfinite(here.energy));
  ASSERT_GT(here.probe_force, 0.0);
  for (int trial = 0; trial < 5; ++trial) {
    // A direction in which the fixed nodes stay.
    Eigen::VectorXd way = Eigen::VectorXd::NullaryExpr(x.size(), [&] { return uniform(random); });
    for (Eigen::Index i = 0; i < way.size(); ++i)
      if (here.gradient[i] == 0.0) way[i] = 0.0;
    constexpr double kStep = 1e-8;
    const ShellEnergy::Value ahead = energy.at(x + kStep * way);
    const ShellEnergy::Value behind = energy.at(x - kStep * way);
    const double slope = (ahead.energy - behind.energy) / (2.0 * kStep);
    EXPECT_NEAR(here.gradient.dot(way), slope, 1e-5 * here.gradient.cwiseAbs().dot(way.cwiseAbs()));
    const Eigen::VectorXd bend = (ahead.gradient - behind.gradient) / (2.0 * kStep);
    const Eigen::VectorXd predicted =
        here.hessian * way + here.gas_stiffness * here.volume.dot(way) * here.volume;
    EXPECT_LT((bend - predicted).norm(), 1e-5 * bend.norm());
  }
}

TEST(Shell, GasAloneKeepsTheInflatedBallAtRest) {
  // The stress-free shape is that of the closed formula for a thick neo-Hookean sphere; the solid elements
  // must agree with it: nothing moves when the probe only just touches.
  for (const double pressure : {10e3, 90e3}) {
    const sim::BallParameters ball = ball_at(pressure);
    const PressedShell state = press_shell(ball, 4, 0.5e-3, {1e-6}).front();
    for (const Vec2& p : state.contour) EXPECT_NEAR(p.norm(), ball.outer_radius, 3e-6);
    EXPECT_LT(state.force, 1e-4);
  }
}

TEST(Shell, ForceIsTheSlopeOfTheEnergyAndOfTheRigsBall) {
  const sim::BallPlant plant;
  const std::vector<double> depths{2e-3, 4e-3, 6e-3};
  const std::vector<PressedShell> states = press_shell(ball_at(10e3), 4, 0.5e-3, depths);
  for (const PressedShell& state : states) {
    EXPECT_LT(state.residual, 1e-7);
    EXPECT_NEAR(state.force / plant.elastic(state.depth), 1.0, 0.1);
    // The felt under the probe lies on it.
    EXPECT_NEAR(state.contour.front()[1], 0.033 - state.depth, 1e-12);
    EXPECT_GT(state.core_depth, 0.0);
    EXPECT_LT(state.core_depth, state.depth);
  }
}

// A shell of middle radius 30 mm under nearly a point: small probe, thin and hard felt.
sim::BallParameters thin(double wall, double pressure) {
  sim::BallParameters ball = ball_at(pressure);
  ball.wall = wall;
  ball.felt = 0.04 * wall;
  ball.felt_modulus = 1e6;
  ball.outer_radius = 30e-3 + 0.5 * wall + ball.felt;
  ball.probe_radius = 2.0 * wall;
  return ball;
}
// Over the deflection of the wall's inner side, which the load does not squeeze.
double stiffness(const sim::BallParameters& ball) {
  const PressedShell state = press_shell(ball, 4, 0.25 * ball.wall, {0.02 * ball.wall}).front();
  return state.force / state.core_depth;
}

TEST(Shell, AThinShellIsAsStiffAsReissners) {
  // Without gas F/w = 4 E h^2 / (R sqrt(3 (1 - nu^2))), the root is 1.5 for nu = 1/2. Shear takes 1.8 h/R of
  // it, the patch and the finite deflection some more; all of that shrinks with the wall.
  const auto ratio = [](double wall) {
    const sim::BallParameters ball = thin(wall, 0.0);
    return stiffness(ball) * 30e-3 * 1.5 / (4.0 * ball.rubber_modulus * wall * wall);
  };
  const double thick = ratio(0.5e-3);
  const double half = ratio(0.25e-3);
  EXPECT_NEAR(thick, 1.0, 0.10);
  EXPECT_NEAR(half, 1.0, 0.06);
  EXPECT_LT(1.0 - half, 0.8 * (1.0 - thick));
}

TEST(Shell, GasStiffensAThinShellAsVellaSays) {
  // Vella et al. 2012, tau > 1: k = 4 pi D / l^2 sqrt(tau^2 - 1) / artanh(sqrt(1 - 1/tau^2))
  // [sources/ball 2].
  const sim::BallParameters ball = thin(0.5e-3, 1.5e3);
  const double bending = ball.rubber_modulus * std::pow(ball.wall, 3) / (12.0 * 0.75);
  const double membrane = ball.rubber_modulus * ball.wall;
  const double length2 = std::sqrt(bending * 9e-4 / membrane);
  const double tau = ball.pressure * 9e-4 / (4.0 * std::sqrt(membrane * bending));
  ASSERT_GT(tau, 1.0);
  const double expected = 4.0 * std::numbers::pi * bending / length2 * std::sqrt(tau * tau - 1.0) /
                          std::atanh(std::sqrt(1.0 - 1.0 / (tau * tau)));
  EXPECT_NEAR(stiffness(ball) / expected, 1.0, 0.10);
}

TEST(Shell, HalvingTheElementsQuartersTheError) {
  const sim::BallParameters ball = ball_at(10e3);
  const auto force = [&](int through, double fine) {
    return press_shell(ball, through, fine, {4e-3}).front().force;
  };
  const double coarse = force(2, 1e-3);
  const double middle = force(4, 0.5e-3);
  const double fine = force(8, 0.25e-3);
  EXPECT_NEAR((middle - coarse) / (fine - middle), 4.0, 1.5);
}

}  // namespace
}  // namespace enc::bench::deformation
