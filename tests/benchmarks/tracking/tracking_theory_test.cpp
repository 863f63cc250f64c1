// The theory of Table 1 against counting: a tracker, a server and a network, packet by packet, written once
// more.
#include "benchmarks/tracking/tracking_theory.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "benchmarks/tracking/tracking_fit.h"

namespace enc::bench::tracking {
namespace {

struct Counted {
  double age = 0.0, rmse = 0.0, mae = 0.0;
};

// A tool that oscillates, as seen by packets of many random phases. Its place is x(t) = 10 mm sin(2 pi t).
Counted count(const ChainSpec& chain, double bias, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53; };
  const auto place = [](double t) { return 0.010 * std::sin(2.0 * M_PI * t); };
  Counted sum;
  double n = 0.0;
  for (int phase = 0; phase < 400; ++phase) {
    const double first = uniform() / chain.rate;
    const double server = uniform() / chain.server_rate;
    double newest = -1.0;
    std::vector<std::pair<double, double>> packets;  // arrival, exposure
    for (int k = 1; k <= 200; ++k) {
      const double now = server + k / chain.server_rate;
      // Tracker and application in a row make one fixed delay.
      const double exposure = first + std::floor((now - chain.fixed - first) * chain.rate) / chain.rate;
      if (exposure <= newest) continue;
      newest = exposure;
      packets.emplace_back(now - chain.jitter * std::log(uniform()), exposure);
    }
    std::sort(packets.begin(), packets.end());
    double seen = -1.0;
    for (const auto& [arrival, exposure] : packets) {
      if (exposure <= seen || exposure < 0.0) continue;
      seen = exposure;
      const double tick = std::ceil(arrival / chain.tick) * chain.tick;
      const double error = place(exposure) - place(tick) + bias;
      sum.age += tick - exposure;
      sum.rmse += error * error;
      sum.mae += std::abs(error);
      ++n;
    }
  }
  return {sum.age / n, std::sqrt(sum.rmse / n), sum.mae / n};
}

TEST(TrackingTheory, AgesAreThoseThatAreCounted) {
  for (const ChainSpec& chain :
       {ChainSpec{120, 100, 0.013, 0.0, 1e-3}, ChainSpec{120, 100, 0.0035, 0.0023, 1e-3},
        ChainSpec{120, 100, 0.005, 0.008, 1e-3}, ChainSpec{60, 100, 0.010, 0.001, 1e-3},
        ChainSpec{120, 50, 0.010, 0.001, 2e-3}}) {
    const Counted counted = count(chain, 0.0, 1);
    const std::vector<double> ages = likely_ages(chain, 64);
    const double mean = std::accumulate(ages.begin(), ages.end(), 0.0) / 64.0;
    EXPECT_NEAR(mean, mean_age(chain), 1e-6);
    EXPECT_NEAR(mean, counted.age, 0.012 * counted.age) << chain.fixed << " " << chain.jitter;
    // The lag of the swing, to first order in the age; and its size.
    double square = 0.0;
    for (const double age : ages)
      square += std::pow(2.0 * std::sin(M_PI * age) * 0.010, 2) / 2.0 / 64.0;  // over all phases of the swing
    EXPECT_NEAR(std::sqrt(square), counted.rmse, 0.015 * counted.rmse);
  }
}

TEST(TrackingTheory, AtRestThereIsBiasAndNoise) {
  const Errors e = at_stops(0.3e-3, 0.4e-3);
  EXPECT_NEAR(e.rmse, 0.5e-3, 1e-15);
  EXPECT_EQ(e.bias, 0.3e-3);
  EXPECT_NEAR(at_stops(0.0, 1.0).mae, std::sqrt(2.0 / M_PI), 1e-12);  // half normal
  EXPECT_NEAR(at_stops(-1.0, 1e-9).mae, 1.0, 1e-12);
}

// By hand: one age, a long move at an even speed; ramps hardly count.
TEST(TrackingTheory, AtAnEvenSpeedTheLagIsSpeedTimesAge) {
  MovesSpec moves;
  moves.stops = {0.0, 10.0};
  moves.speed = 0.040;
  const Lag lag({0.020}, moves);
  EXPECT_NEAR(lag.errors(0.0, 0.0).mae, 0.8e-3, 1e-6);
  EXPECT_NEAR(lag.errors(0.1e-3, 0.0, 1).mae, 0.7e-3, 1e-6);   // opposes
  EXPECT_NEAR(lag.errors(0.1e-3, 0.0, -1).mae, 0.9e-3, 1e-6);  // adds
  EXPECT_NEAR(lag.errors(0.1e-3, 0.0, 0).mae, 0.8e-3, 1e-6);
  EXPECT_NEAR(lag.errors(0.1e-3, 0.3e-3, 1).rmse, std::hypot(0.7e-3, 0.3e-3), 1e-6);
  EXPECT_NEAR(lag.errors(0.1e-3, 0.0, 0).bias, 0.1e-3, 1e-9);
}

TEST(TrackingTheory, SlowerRampsMakeLessLagAndTheMovesAreThePapers) {
  const std::vector<double> ages{0.018};
  double before = INFINITY;
  for (const double acceleration : {4.0, 1.0, 0.41, 0.25}) {
    MovesSpec moves;
    moves.speed = 0.040;
    moves.acceleration = acceleration;
    const double mae = Lag(ages, moves).errors(0.0, 0.0).mae;
    EXPECT_LT(mae, before);
    before = mae;
    // The machine is on the move for 1 s + 4 v / a and its servo's tail; the mean lag is age * way / that.
    if (acceleration < 0.41) continue;  // then the shorter moves do not reach their speed
    EXPECT_NEAR(mae, 0.018 * 0.040 / (1.0 + 4.0 * 0.040 / acceleration + 4.0 * 0.020), 0.04 * mae);
  }
}

TEST(TrackingFit, FindsTheChainThatMadeATable) {
  const std::array<AxisError, 3> axes{{{0.08e-3, 0.02e-3}, {0.07e-3, 0.01e-3}, {0.12e-3, 0.01e-3}}};
  ChainSpec chain{120, 100, 0.0121, 0.0013, 1e-3};
  MovesSpec moves;
  const Table1 table = candidate_of(chain, moves, axes).table[0];
  const auto found = axis_errors(table);
  for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(found[a].bias, axes[a].bias, 1e-8);
  const auto candidates = spread(chain, moves, found, 150, moves.acceleration);
  const Candidate c = best(candidates, table, BiasSide::opposes, Judge::worst, chain, moves, false);
  EXPECT_LT(misfit(c.table[0], table).worst, 0.1);
  EXPECT_NEAR(c.fixed + c.jitter, 0.0134, 0.3e-3);
  EXPECT_GT(misfit(c.table[1], table).worst, 1.0);
  const Predicted40 prediction = predict_40(candidates, table, BiasSide::opposes, 1);
  EXPECT_LT(prediction.low[2][3].rmse, table[2][3].rmse);
  EXPECT_GT(prediction.high[2][3].rmse, table[2][3].rmse);
}

}  // namespace
}  // namespace enc::bench::tracking
