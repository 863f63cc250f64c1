// Latency, bias and noise out of logs that were made by hand: exact where the log is exact, and silent where
// it cannot tell.
#include "models/identify/tracker/latency_fit.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "benchmarks/tracking/motion.h"

namespace enc::models {
namespace {

using bench::tracking::Motion;
using bench::tracking::MotionPoint;

constexpr double kPeriod = 1e-3;  // s

struct Made {
  Vec3 bias{0.1e-3, -0.05e-3, 0.2e-3};
  double noise = 0.0;                                                          // m
  std::function<double(std::size_t)> age = [](std::size_t) { return 0.020; };  // s, of packet k
  Vec3 turning{0, 0, 0};  // m: adds to the lag, whatever the speed
  bool stamped = false;
  double stamp_late = 0.0;  // s
};

// A packet every 10 ms along a motion.
TrackerLog log_of(const Motion& motion, const Made& made) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  TrackerLog log;
  log.period = kPeriod;
  log.packet_period = 0.010;
  for (int n = 0; n * kPeriod < motion.duration; ++n) {
    const double t = n * kPeriod;
    log.time.push_back(t);
    log.tip.push_back(motion.at(t).position);
    if (n % 10 != 3) continue;
    const double at = t - made.age(log.packets.size());
    const MotionPoint then = motion.at(at);
    Vec3 tool = then.position + made.bias;
    for (Eigen::Index a = 0; a < 3; ++a) {
      tool(a) += made.noise * normal(random);
      if (std::abs(then.velocity(a)) > 1e-3) tool(a) -= std::copysign(made.turning(a), then.velocity(a));
    }
    log.packets.push_back({t, made.stamped ? at + made.stamp_late : kUnset, tool});
  }
  return log;
}

Motion diagonal(double speed = 0.040, bool both_ways = true) {
  bench::tracking::StopsSpec moves;
  moves.direction = Vec3(0.6, 0.0, 0.8);
  moves.speed = speed;
  moves.dwell = 0.5;
  moves.both_ways = both_ways;
  return bench::tracking::moves_with_stops(moves);
}

TEST(LatencyFit, IsExactWhereTheLogIs) {
  const LatencyFit fit = fit_latency(log_of(diagonal(), {}));
  EXPECT_NEAR(fit.latency.value, 0.020, 2e-6);
  EXPECT_LT(fit.latency.half, 1e-5);
  EXPECT_NEAR(fit.axes[0].latency.value, 0.020, 2e-6);
  EXPECT_NEAR(fit.axes[0].bias.value, 0.1e-3, 1e-8);
  EXPECT_NEAR(fit.axes[1].bias.value, -0.05e-3, 1e-8);
  EXPECT_NEAR(fit.axes[2].bias.value, 0.2e-3, 1e-8);
  EXPECT_EQ(fit.outliers, 0U);
}

TEST(LatencyFit, SaysNothingOfAnAxisThatStandsStill) {
  const LatencyFit fit = fit_latency(log_of(diagonal(), {}));
  EXPECT_TRUE(std::isnan(fit.axes[1].latency.value));
  EXPECT_EQ(fit.axes[1].moving, 0U);
  const LatencyFit rest = fit_latency(log_of(bench::tracking::at_rest(3.0), {.noise = 10e-6}));
  EXPECT_FALSE(rest.latency.known());
  EXPECT_FALSE(rest.scatter.known());
  for (const AxisLatency& axis : rest.axes) EXPECT_NEAR(axis.noise, 10e-6, 1.5e-6);
  EXPECT_TRUE(rest.axes[0].bias.holds(0.1e-3)) << rest.axes[0].bias.value;
}

TEST(LatencyFit, MeanAndScatterOfAges) {
  // Ages of 15 and 25 ms in turn: 20 ms, 5 ms.
  const LatencyFit fit =
      fit_latency(log_of(diagonal(), {.age = [](std::size_t k) { return k % 2 == 0 ? 0.015 : 0.025; }}));
  EXPECT_NEAR(fit.latency.value, 0.020, 0.1e-3);
  EXPECT_NEAR(fit.scatter.value, 0.005, 0.2e-3);
}

TEST(LatencyFit, NegativeAndLongLatencies) {
  for (const double age : {-0.050, 0.0, 0.300}) {
    const LatencyFit fit = fit_latency(log_of(diagonal(), {.age = [=](std::size_t) { return age; }}));
    EXPECT_NEAR(fit.latency.value, age, 5e-6);
  }
}

// Half a second has no packet that is known to be 500 ms old: that none is left over explains nothing.
TEST(LatencyFit, AShortLogHasNoAgeOfWhichItKnowsNoPacket) {
  TrackerLog log;
  log.period = kPeriod;
  log.packet_period = 0.010;
  const auto place = [](double t) { return Vec3(0.010 * std::sin(6.0 * M_PI * t), 0.0, 0.0); };
  for (int n = 0; n < 500; ++n) {
    const double t = n * kPeriod;
    log.time.push_back(t);
    log.tip.push_back(place(t));
    if (n % 10 == 3) log.packets.push_back({t, kUnset, place(t - 0.020)});
  }
  const LatencyFit fit = fit_latency(log);
  EXPECT_TRUE(fit.in_range);
  EXPECT_NEAR(fit.latency.value, 0.020, 1e-3);
  EXPECT_GT(fit.packets, 40U);
}

TEST(LatencyFit, OneWayIsMarked) {
  const LatencyFit one = fit_latency(log_of(diagonal(0.040, false), {}));
  EXPECT_TRUE(one.axes[0].one_way);
  EXPECT_FALSE(one.axes[0].change.known());
  EXPECT_NEAR(one.latency.value, 0.020, 2e-6);
  const LatencyFit both = fit_latency(log_of(diagonal(), {}));
  EXPECT_FALSE(both.axes[0].one_way);
  EXPECT_NEAR(both.axes[0].change.value, 0.0, 1e-7);
}

// 50 um that add to the lag either way are 50 um / speed of latency, unless two speeds tell them apart.
TEST(LatencyFit, ALagThatDoesNotGrowWithSpeed) {
  const Motion slow = diagonal(0.015);
  const Motion fast = diagonal(0.045);
  const Motion two{"two speeds", slow.duration + fast.duration,
                   [=](double t) { return t < slow.duration ? slow.at(t) : fast.at(t - slow.duration); }};
  const LatencyFit fit = fit_latency(log_of(two, {.noise = 5e-6, .turning = Vec3(50e-6, 0, 0)}));
  EXPECT_NEAR(fit.axes[0].step.value, 50e-6, 10e-6);
  EXPECT_GT(fit.axes[0].step.value, fit.axes[0].step.half);
  EXPECT_NEAR(fit.axes[2].step.value, 0.0, 10e-6);
  EXPECT_FALSE(fit.axes_agree) << "x lags more than z";
}

TEST(LatencyFit, OutliersAreLeftOut) {
  TrackerLog log = log_of(diagonal(), {.noise = 10e-6});
  for (std::size_t k = 50; k < log.packets.size(); k += 97) log.packets[k].tool.x() += 5e-3;
  const LatencyFit fit = fit_latency(log);
  EXPECT_NEAR(static_cast<double>(fit.outliers), static_cast<double>(log.packets.size()) / 97.0, 3.0);
  EXPECT_NEAR(fit.latency.value, 0.020, 0.2e-3);
  EXPECT_NEAR(fit.axes[0].bias.value, 0.1e-3, 2e-6);
}

TEST(LatencyFit, StampsAreCompared) {
  const auto age = [](std::size_t k) { return 0.012 + 0.001 * static_cast<double>(k % 7); };  // mean 15 ms
  const LatencyFit fit =
      fit_latency(log_of(diagonal(), {.noise = 5e-6, .age = age, .stamped = true, .stamp_late = 0.003}));
  EXPECT_NEAR(fit.stamp_age.value, 0.012, 0.1e-3);
  EXPECT_NEAR(fit.stamp_error.value, 0.003, 0.1e-3);
  EXPECT_TRUE(fit.stamp_error.holds(0.003));
  EXPECT_NEAR(fit.latency.value, 0.015, 0.2e-3);
}

// Tables of Student's t: 12.7 apart, which no block count here needs.
TEST(BlockError, StudentsQuantile) {
  EXPECT_NEAR(student(1e9), 1.95996, 1e-4);
  EXPECT_NEAR(student(30), 2.0423, 1e-3);
  EXPECT_NEAR(student(10), 2.2281, 2e-3);
  EXPECT_NEAR(student(5), 2.5706, 0.02);
}

// Two blocks with influences +-1: variance 2 * 2 / 1.
TEST(BlockError, TwoBlocks) {
  const Blocks blocks{{1.0, -1.0}, {1.0, 1.0}};
  EXPECT_DOUBLE_EQ(blocks.variance(), 4.0);
  EXPECT_DOUBLE_EQ(blocks.freedom(), 1.0);
}

}  // namespace
}  // namespace enc::models
