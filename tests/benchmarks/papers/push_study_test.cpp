// Judging a push: what counts as unstable, what a steady mean is; and the boundary of stability, which has to
// follow from the parameters as the linear theory says where that holds.
#include "benchmarks/stiffness/push_study.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "benchmarks/stiffness/stiffness.h"
#include "tests/support/built.h"

namespace enc::bench::stiffness {
namespace {

constexpr double kPeriod = 1e-3;  // s

std::vector<double> swing(double amplitude, double frequency, double decay = 0.0, std::size_t n = 3000) {
  std::vector<double> way(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) * kPeriod;
    way[i] = 0.015 + amplitude * std::exp(-decay * t) * std::sin(2.0 * std::numbers::pi * frequency * t);
  }
  return way;
}
bool unstable(const std::vector<double>& way) {
  Push push;
  push.peak_to_peak = peak_to_peak(way);
  return push.unstable();
}

TEST(PushStudy, InstabilityIsSeenInTheMotion) {
  EXPECT_NEAR(peak_to_peak(swing(0.6e-3, 2.6)), 1.2e-3, 1e-6);
  EXPECT_TRUE(unstable(swing(0.51e-3, 2.6)));     // keeps swinging
  EXPECT_TRUE(unstable(swing(0.1e-3, 2.6, -1)));  // grows
  EXPECT_FALSE(unstable(swing(0.49e-3, 2.6)));
  EXPECT_FALSE(unstable(swing(0.0, 2.6)));
  const std::vector<double> dying = swing(5e-3, 2.6, 3.0, 6000);
  EXPECT_FALSE(unstable({dying.begin() + 3000, dying.end()}));  // came to rest
  EXPECT_TRUE(unstable({}));                                    // was never seen at rest
  EXPECT_TRUE(unstable({0.015, kUnset, 0.015}));
  EXPECT_TRUE(Push{}.unstable());
}

TEST(PushStudy, SteadyMeanDoesNotDependOnWhereASwingIsCut) {
  for (const double frequency : {1.7, 2.6, 5.3, 64.0})
    EXPECT_NEAR(steady_mean(swing(1e-3, frequency)), 0.015, 0.004 * 1e-3) << frequency;
  EXPECT_NEAR(steady_mean(std::vector<double>(1000, 2.5)), 2.5, 1e-12);
}

TEST(PushStudy, FindsTheStrongestFrequency) {
  for (const double frequency : {2.5, 8.0, 64.0})
    EXPECT_NEAR(strongest_frequency(swing(1e-3, frequency), kPeriod), frequency, 0.26);
  EXPECT_TRUE(std::isnan(strongest_frequency(std::vector<double>(1000, 2.5), kPeriod)));
}

TEST(PushStudy, SlopeOfAnAbsoluteForceErrorIsMinusOne) {
  std::vector<Level> levels;
  for (const double k : {30.0, 60.0, 300.0, 5000.0}) {
    Push push;
    push.stiffness = k;
    push.measured = k * (1.0 + 0.05 / (k * 0.015));
    push.load = k * 1.01;
    levels.push_back({k, {push, push}});
  }
  EXPECT_NEAR(error_slope(levels, &Push::measured, 30, 300), -1.0, 1e-9);
  EXPECT_NEAR(error_slope(levels, &Push::load, 30, 300), 0.0, 1e-9);
  EXPECT_NEAR(spread(levels[0], &Push::measured).worst(), 100.0 / 9.0, 1e-9);
}

models::Setup setup_with(const std::vector<std::string>& variant) {
  return push_setup(tests::source_dir() + "/models", {}, variant);
}

TEST(PushStudy, AForceErrorBecomesTheErrorThatItHasToBe) {
  // 0.05 N of threshold at 0.1 N/mm: the pusher (k_h) finds x with k_h (x_s - x) = k x + 0.05.
  const models::Setup setup =
      with_stiffness(setup_with({"truth.pusher.tremor_N=0", "truth.force.drift_N_per_push=0"}), 100);
  const double k_h = setup.twin.pusher.stiffness;
  const double x = (k_h * 0.015 + 1.5 - 0.05) / (k_h + 100.0);
  const Push push = push_once(setup, 1);
  EXPECT_NEAR(push.error(push.measured), 100.0 * 0.05 / (100.0 * x), 0.02);
  EXPECT_FALSE(push.unstable());
}

TEST(PushStudy, TheLoadIsFreeOfTheZerosError) {
  const Push push = push_once(with_stiffness(setup_with({"truth.force.drift_N_per_push=0.3"}), 1000), 3);
  EXPECT_GT(std::abs(push.error(push.load) - push.error(push.measured)), 0.3);  // a zero that is 0.3 N off
  // What the core took for pressing is in x; the load is not: the two differ by zero / (k x).
  const Push exact = push_once(with_stiffness(setup_with({"truth.force.drift_N_per_push=0"}), 1000), 3);
  EXPECT_NEAR(exact.error(exact.load), exact.error(exact.measured), 0.05);
}

// Where nothing saturates the boundary follows the linear loop: in place, and in what each parameter does.
TEST(PushStudy, BoundaryMovesAsTheLinearTheorySays) {
  const auto boundary = [](const std::vector<std::string>& change, double& linear) {
    std::vector<std::string> variant = unlimited_acceleration();
    variant.emplace_back("truth.pusher.stiffness_N_per_mm=1");
    variant.emplace_back("pusher.hold_s=4");
    variant.insert(variant.end(), change.begin(), change.end());
    const models::Setup setup = setup_with(variant);
    linear = lowest_stable_stiffness(pushed_loop(setup));
    return StabilityMap(setup, 1, 1, 1.0, 2.0).lowest_stable(linear);
  };
  double before_linear = 0.0;
  const double before = boundary({}, before_linear);
  EXPECT_NEAR(before / before_linear, 1.0, 0.15);
  struct Change {
    const char* set;
    bool up;
  };
  for (const Change& change :
       {Change{"truth.pusher.stiffness_N_per_mm=1.5", true},
        Change{"truth.pusher.stiffness_N_per_mm=0.6", false}, Change{"rig.force.filter_hz=8", true},
        Change{"truth.hexapod.delay_cycles=12", true}, Change{"truth.hexapod.servo_hz=25", false}}) {
    double linear = 0.0;
    const double after = boundary({change.set}, linear);
    EXPECT_EQ(after > before, change.up) << change.set;
    EXPECT_NEAR(after / before, linear / before_linear, 0.08 * linear / before_linear) << change.set;
  }
}

TEST(PushStudy, LowestStableIsFoundFromAnyGuess) {
  const models::Setup setup = setup_with({"pusher.hold_s=3"});
  StabilityMap map(setup, 7, 2, 1.0, 2.0);
  const double lowest = map.lowest_stable(30);
  EXPECT_GT(map.unstable_share(lowest - 2.0), 0.0);
  EXPECT_EQ(map.unstable_share(lowest), 0.0);
  EXPECT_EQ(StabilityMap(setup, 7, 2, 1.0, 2.0).lowest_stable(200), lowest);
  EXPECT_EQ(StabilityMap(setup, 7, 2, 1.0, 2.0).lowest_stable(5), lowest);
}

}  // namespace
}  // namespace enc::bench::stiffness
