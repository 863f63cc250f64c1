// The ball behind loops: whitening by hand, exact data that give the ball back, and the report of
// undetermined parameters.
#include "trial/identify/ball/ball_fit.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "sim/truth/random.h"
#include "tests/support/plant_loop.h"

namespace enc::bench {
namespace {

// Two pushes, walk 2 per s: the first mean of each is the zero; the second of the first push has variance
// 1/4 + 2 * 0.5 + 1/1 = 2.25 and stands 3 above it; the third is seen from the level in between, which has
// moved by 1.25 / 2.25 of the 3.
TEST(DriftingNoise, WhitensAsByHand) {
  const std::vector<models::NoisyMean> means{
      {0.0, 4.0, true}, {0.5, 1.0, false}, {1.0, 2.0, false}, {9.0, 1.0, true}};
  Eigen::MatrixXd column(4, 1);
  column << 1.0, 4.0, 4.0, 70.0;
  const double logs = models::whiten(means, {2.0}, column);
  EXPECT_EQ(column(0), 0.0);
  EXPECT_NEAR(column(1), 3.0 / 1.5, 1e-12);
  const double gain = 1.25 / 2.25, variance = 1.25 * (1.0 - gain) + 2.0 * 0.5 + 0.5;
  EXPECT_NEAR(column(2), (4.0 - (1.0 + gain * 3.0)) / std::sqrt(variance), 1e-12);
  EXPECT_EQ(column(3), 0.0);
  EXPECT_NEAR(logs, std::log(2.25) + std::log(variance), 1e-12);
}

// A zero that wanders by 0.3 a second's root under readings of 1: the fit finds the walk and its uncertainty.
TEST(DriftingNoise, FindsTheWalk) {
  constexpr double kWalk = 0.09;
  sim::Stream random(3, "walk");
  std::vector<models::NoisyMean> means;
  Eigen::VectorXd left(8000);
  double zero = 0.0;
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    means.push_back({0.1 * static_cast<double>(i), 1.0, i == 0});
    zero += std::sqrt(kWalk * 0.1) * random.normal();
    left[i] = zero + random.normal();
  }
  const models::DriftingNoise found = models::drifting_noise(means, left, Eigen::MatrixXd(left.size(), 0));
  EXPECT_NEAR(std::log(found.walk / kWalk), 0.0, 3.0 * std::sqrt(2.0 / found.sureness));
  EXPECT_GT(found.sureness, 50.0);
}

void expect_ball(const trial::BallFit& fit, const trial::StandingBall& truth, double within) {
  for (const trial::BallEstimate& e : fit.estimates) {
    const trial::BallNumber& n = trial::ball_numbers()[e.number];
    EXPECT_NEAR(e.interval.value / n.scale, trial::value_of(n, truth) / n.scale, within) << n.name;
  }
}

TEST(BallFit, GivesTheBallBackFromExactReadings) {
  sim::BallParameters ball;
  ball.rubber_modulus *= 0.87;
  ball.pressure *= 1.3;
  ball.felt_modulus *= 1.25;
  ball.friction *= 0.7;
  ball.friction_travel *= 1.2;
  ball.relaxing = {0.045, 0.065, 0.04};
  expect_ball(trial::fit_ball(trial::BallLoops({test::ball_pushes(ball, {})})), {ball, 0.0}, 1e-6);
}

// Far from the start of the search: 8 MPa, 75 kPa; the thickness of its felt is known.
TEST(BallFit, FindsABallAsPlayedWith) {
  const sim::BallParameters ball = sim::ball_set(sim::BallSet::regulation);
  trial::BallFitOptions options;
  options.start.law.felt = ball.felt;
  expect_ball(trial::fit_ball(trial::BallLoops({test::ball_pushes(ball, {})}), options), {ball, 0.0}, 1e-6);
}

// Two runs at different speeds are one ball, which stands 0.1 mm nearer than assumed. The path before the
// first reading is then guessed, so the last digit differs.
TEST(BallFit, FindsWhereTheBallStands) {
  test::PushProgramme fast{20e-3, 6e-3, 0.0};
  test::PushProgramme slow{4e-3, 6e-3, 4.0};
  fast.nearer = slow.nearer = 0.1e-3;
  const trial::BallFit fit =
      trial::fit_ball(trial::BallLoops({test::ball_pushes({}, fast), test::ball_pushes({}, slow)}));
  expect_ball(fit, {{}, 0.1e-3}, 2e-3);
}

TEST(BallFit, JacobianAgainstCentralDifferences) {
  const trial::BallLoops loops({test::ball_pushes({}, {20e-3, 6e-3, 0.5})});
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < trial::kBallNumbers; ++i) all.push_back(i);
  const Eigen::MatrixXd jacobian = trial::ball_jacobian(loops, {}, all);
  for (std::size_t i = 0; i < trial::kBallNumbers; ++i) {
    constexpr double kStep = 1e-4;
    const trial::BallNumber& n = trial::ball_numbers()[i];
    trial::StandingBall less;
    trial::StandingBall more;
    n.of(less) -= kStep * n.scale;
    n.of(more) += kStep * n.scale;
    const Eigen::VectorXd central = (loops.predicted(sim::BallPlant(more.law), more.nearer) -
                                     loops.predicted(sim::BallPlant(less.law), less.nearer)) /
                                    (2.0 * kStep);
    const Eigen::VectorXd column = jacobian.col(static_cast<Eigen::Index>(i));
    EXPECT_GT(central.norm(), 0.0) << n.name;
    EXPECT_LT((column - central).norm(), 1e-3 * central.norm()) << n.name;
  }
}

// A push without a dwell lasts 0.6 s: it does not determine a process of 5 s, nor whether modulus or
// thickness makes the felt soft. Two with a dwell, the thickness given, determine all.
TEST(BallFit, SaysWhatLoopsDoNotTell) {
  trial::Pushes pushes = test::ball_pushes({}, {20e-3, 6e-3, 0.0, 2.0, 1});
  test::add_noise(pushes, 1);
  trial::BallFitOptions options;
  options.free[trial::kFelt] = true;
  for (const trial::BallEstimate& e : trial::fit_ball(trial::BallLoops({pushes}), options).estimates) {
    if (e.number != trial::kRelaxingSlow && e.number != trial::kFelt) continue;
    EXPECT_EQ(e.known(), trial::EstimateQuality::not_at_all)
        << trial::ball_numbers()[e.number].name << " " << e.width();
    EXPECT_LT(e.alone, 0.1 * e.interval.half) << "alone it would be known";
  }
  pushes = test::ball_pushes({}, {});
  test::add_noise(pushes, 1);
  for (const trial::BallEstimate& e : trial::fit_ball(trial::BallLoops({pushes})).estimates)
    EXPECT_EQ(e.known(), trial::EstimateQuality::well)
        << trial::ball_numbers()[e.number].name << " " << e.width();
}

// The travel of friction is undetermined without friction.
TEST(BallFit, AnIntervalMayBeInfinite) {
  sim::BallParameters ball{.friction = 0.0};
  trial::Pushes pushes = test::ball_pushes(ball, {});
  test::add_noise(pushes, 1);
  trial::BallFitOptions options;
  options.start.law.friction = 0.0;
  options.free[trial::kFriction] = false;
  const trial::BallFit fit = trial::fit_ball(trial::BallLoops({pushes}), options);
  for (const trial::BallEstimate& e : fit.estimates)
    EXPECT_EQ(std::isinf(e.interval.half), e.number == trial::kFrictionTravel);
}

// A wall assumed 1 % thicker than it is: the remaining parameters shift as stated.
TEST(BallFit, SaysWhatItOwesToWhatIsHeld) {
  const trial::Pushes pushes = test::ball_pushes({}, {});
  const trial::BallFit right = trial::fit_ball(trial::BallLoops({pushes}));
  trial::BallFitOptions wrong;
  wrong.start.law.wall *= 1.01;
  const trial::BallFit moved = trial::fit_ball(trial::BallLoops({pushes}), wrong);
  const trial::HeldNumber& wall = right.held.front();
  ASSERT_EQ(wall.number, trial::kWall);
  const double told = wall.moves[trial::kRubberModulus];
  EXPECT_LT(told, -1.0);
  EXPECT_NEAR(moved.estimates[trial::kRubberModulus].interval.value /
                  right.estimates[trial::kRubberModulus].interval.value,
              1.0 + 0.01 * told, 0.1 * 0.01 * std::abs(told));
}

TEST(BallFit, RefusesTooFewReadings) {
  trial::Pushes pushes = test::ball_pushes({}, {20e-3, 6e-3, 0.0, 2.0, 1});
  pushes.front().resize(50);
  EXPECT_THROW(static_cast<void>(trial::fit_ball(trial::BallLoops({pushes}))), Error);
}

}  // namespace
}  // namespace enc::bench
