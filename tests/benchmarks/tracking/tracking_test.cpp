// Scripted motions and their measurement by a tracker of known age; the theory of Table 1; and both in random
// rigs.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/tracking/forensics.h"
#include "benchmarks/tracking/motion.h"
#include "benchmarks/tracking/table1.h"
#include "benchmarks/tracking/tracking_fit.h"
#include "sim/plants/tracker_plant.h"
#include "tests/support/built.h"

namespace enc::bench::tracking {
namespace {

// Scripted motions: speed is the derivative of position, ends and peaks are as requested; and the measurement
// of these motions by a tracker of known age.

double greatest_speed(const Motion& motion) {
  constexpr double kStep = 1e-5;
  double fastest = 0.0;
  for (double t = 0.0005; t < motion.duration; t += 0.00173) {
    const MotionPoint here = motion.at(t);
    const Vec3 change = motion.at(t + kStep).position - motion.at(t - kStep).position;
    EXPECT_LT((change / (2.0 * kStep) - here.velocity).norm(), 3e-6) << motion.name << " at " << t;
    fastest = std::max(fastest, here.velocity.norm());
  }
  return fastest;
}

TEST(Motion, MovesWithStopsAreTrapezoids) {
  StopsSpec spec;
  spec.from = Vec3(0, 0, -0.020);
  spec.direction = Vec3(0, 0, 2);
  const Motion motion = moves_with_stops(spec);
  EXPECT_NEAR(greatest_speed(motion), 0.040, 1e-12);
  // A move of 20 mm at 40 mm/s and 0.41 m/s^2 takes 0.5 s plus one ramp of 97.6 ms.
  const double ramp = 0.040 / 0.41;
  EXPECT_NEAR(motion.duration, 9 * 5.0 + 2 * (0.040 / 0.040 + 4 * ramp), 1e-9);
  EXPECT_EQ(motion.at(-1.0).position, Vec3(0, 0, -0.020));
  EXPECT_NEAR((motion.at(0.5 * motion.duration).position - Vec3(0, 0, 0.020)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((motion.at(motion.duration + 1.0).position - Vec3(0, 0, -0.020)).norm(), 0.0, 1e-15);
}

TEST(Motion, AShortMoveDoesNotReachItsSpeed) {
  StopsSpec spec;
  spec.stops = {0.0, 0.001};
  EXPECT_NEAR(greatest_speed(moves_with_stops(spec)), std::sqrt(0.001 * 0.41), 0.41 * 0.00173);  // samples
}

TEST(Motion, ReachesHaveTheirPeakAndComeBack) {
  for (const ReachShape* shape : {&minimum_jerk(), &early_peak(), &two_movements()}) {
    EXPECT_NEAR(shape->way(0.0), 0.0, 1e-15);
    EXPECT_NEAR(shape->way(1.0), 1.0, 1e-12) << shape->name;
    const Motion motion = reaches(*shape, {});
    EXPECT_NEAR(greatest_speed(motion), 0.040, 1e-5) << shape->name;
    EXPECT_NEAR(motion.at(motion.duration).position.norm(), 0.0, 1e-15) << shape->name;
  }
}

TEST(Motion, TremorHasItsSizeAndAStopIsAStop) {
  const Motion shaking = with_tremor(at_rest(100.0), 0.05e-3, 8.0, 12.0, 3);
  double sum = 0.0;
  for (int ms = 0; ms < 100000; ++ms) sum += std::pow(shaking.at(1e-3 * ms).position.x(), 2);
  EXPECT_NEAR(std::sqrt(sum / 1e5), 0.05e-3, 0.005e-3);
  greatest_speed(shaking);
  const Motion hit = stopped(swing(Vec3(0.003, 0, 0), 2.0, 5.0), 0.05);
  EXPECT_EQ(hit.at(0.06).position, hit.at(4.0).position);
  EXPECT_EQ(hit.at(0.06).velocity.norm(), 0.0);
}

// ---- through the tracker
// -------------------------------------------------------------------------------------------

std::array<TipErrors, 3> errors_with(const std::vector<std::string>& more) {
  std::vector<std::string> set{"truth.tracker.bias_mm=[0,0,0]", "truth.tracker.noise_mm=[0,0,0]",
                               "truth.tracker.marker_noise_mm=0", "truth.tracker.udp_delay_ms=0",
                               "truth.tracker.packets=event"};
  set.insert(set.end(), more.begin(), more.end());
  const models::Setup setup =
      models::load(tests::source_dir() + "/models/scenes/tennis_ball.toml", "sim", set);
  StopsSpec spec;
  spec.stops = {0.0, 0.080};
  spec.dwell = 0.5;
  spec.both_ways = false;
  // The window lies within the motion at constant speed.
  const PredictionRun run{moves_with_stops(spec), setup.twin.tracker, 1, true, 0.8, 2.4};
  return predicted_run(prepare(setup.scene, setup.rig), pose_of<'W', 'C'>(setup.twin.frames.W_C), run);
}

// A tool with a held pose lags by its speed times the age of the pose: a longer latency shows in full.
TEST(PredictedRun, HoldingIsBehindByTheAge) {
  const TipErrors early = errors_with({"truth.tracker.latency_ms=0"})[0];
  const TipErrors late = errors_with({"truth.tracker.latency_ms=10"})[0];
  EXPECT_NEAR(late.peak - early.peak, 0.040 * 0.010, 0.040 * 0.001);
  EXPECT_NEAR(late.at_packets - early.at_packets, 0.040 * 0.010, 0.040 * 0.001);
  EXPECT_NEAR(early.at_ticks - early.at_packets, 0.040 * 0.5 / 120.0,
              0.040 * 0.001);  // half a frame on average
}

// Prediction at constant speed removes all of that lag, and adds the error of a wrong stamp.
TEST(PredictedRun, PredictionLeavesWhatTheStampsGetWrong) {
  const std::array<TipErrors, 3> right = errors_with({});
  const std::array<TipErrors, 3> wrong = errors_with({"truth.tracker.stamp_error_ms=3"});
  const std::array<TipErrors, 3> known =
      errors_with({"truth.tracker.stamp_error_ms=3", "rig.tracker.stamp_late_ms=3"});
  for (const std::size_t k : {1U, 2U}) {
    EXPECT_LT(right[k].at_ticks, 20e-6);
    EXPECT_NEAR(wrong[k].at_ticks, 0.040 * 0.003, 20e-6);
    EXPECT_NEAR(known[k].at_ticks, right[k].at_ticks, 1e-9);
  }
}

// The theory of Table 1 against counting: an independent tracker, server and network, packet by packet.

struct TrackingScore {
  double age = 0.0, rmse = 0.0, mae = 0.0;
};

// Packets with many random phases measure a tool that oscillates: x(t) = 10 mm sin(2 pi t).
TrackingScore count(const ChainSpec& chain, double bias, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53; };
  const auto place = [](double t) { return 0.010 * std::sin(2.0 * M_PI * t); };
  TrackingScore sum;
  double n = 0.0;
  for (int phase = 0; phase < 400; ++phase) {
    const double first = uniform() / chain.rate;
    const double server = uniform() / chain.server_rate;
    double newest = -1.0;
    std::vector<std::pair<double, double>> packets;  // arrival, exposure
    for (int k = 1; k <= 200; ++k) {
      const double now = server + k / chain.server_rate;
      // Tracker and application in series add one fixed delay.
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
    const TrackingScore counted = count(chain, 0.0, 1);
    const std::vector<double> ages = likely_ages(chain, 64);
    const double mean = std::accumulate(ages.begin(), ages.end(), 0.0) / 64.0;
    EXPECT_NEAR(mean, mean_age(chain), 1e-6);
    EXPECT_NEAR(mean, counted.age, 0.012 * counted.age) << chain.fixed << " " << chain.jitter;
    // The lag of the oscillation, to first order in the age; and its size.
    double square = 0.0;
    for (const double age : ages)
      // Mean over all phases of the oscillation.
      square += std::pow(2.0 * std::sin(M_PI * age) * 0.010, 2) / 2.0 / 64.0;
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

// Computed by hand: one age, a long move at constant speed; ramps hardly count.
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
    // The machine moves for 1 s + 4 v / a and its servo's tail; the mean lag is age * path / that time.
    if (acceleration < 0.41) continue;  // otherwise the shorter moves do not reach their speed
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

// The twin of Table 1 against the chain's own theory: for random chains, and for each parameter alone.

models::Setup setup_with(std::vector<std::string> set) {
  std::vector<std::string> all{"travel.axes=\"x\"", "travel.speed_mm_s=40", "travel.dwell_s=0.5"};
  all.insert(all.end(), set.begin(), set.end());
  return models::load(tests::source_dir() + "/models/scenes/tracking.toml", "sim", all);
}

// The twin's errors over `seeds` phases of the clocks, forward.
Errors twin_of(const models::Setup& setup, std::uint64_t seeds) {
  TravelErrors sum;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) sum.add(run_travel(setup, seed, false));
  return sum.forward[0].errors();
}
Errors theory_of(const models::Setup& setup) {
  const ToolSpec& tool = setup.scene.tools.front();
  const sim::TrackerTruth truth = sim::with_tool_known(setup.twin.tracker, tool.markers, tool.tip);
  return Lag(likely_ages(chain_of(setup)), moves_of(setup)).errors(truth.bias.x(), truth.noise.x());
}

TEST(TrackingProperty, TwinAndTheoryAgreeForRandomChains) {
  std::mt19937_64 random(4);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
  };
  for (int i = 0; i < 6; ++i) {
    const double acceleration = uniform(0.25, 2.0);
    const models::Setup setup = setup_with(
        {fmt::format("truth.tracker.latency_ms={}", uniform(2, 15)),
         fmt::format("truth.tracker.process_ms={}", uniform(0, 8)),
         fmt::format("truth.tracker.udp_delay_ms={}", uniform(0, 6)),
         fmt::format("truth.tracker.bias_mm=[{}, 0, 0]", uniform(-0.2, 0.2)),
         fmt::format("truth.tracker.noise_mm=[{}, 0, 0]", uniform(0, 0.1)), "truth.tracker.marker_noise_mm=0",
         fmt::format("truth.tracker.rate_hz={}", uniform(90, 200)),
         fmt::format("truth.tracker.server_rate_hz={}", uniform(40, 110)),
         fmt::format("truth.hexapod.acceleration_m_s2={}", acceleration),
         fmt::format("rig.manipulator.acceleration_m_s2={}", acceleration),
         fmt::format("travel.speed_mm_s={}", uniform(10, 45))});
    const Errors twin = twin_of(setup, 10);
    const Errors theory = theory_of(setup);
    EXPECT_NEAR(twin.rmse, theory.rmse, 0.04 * theory.rmse) << i;
    EXPECT_NEAR(twin.mae, theory.mae, 0.04 * theory.mae) << i;
  }
}

// The seeds are equal before and after, so only the parameter changes.
TEST(TrackingProperty, EachParameterMovesTheFiguresAsTheTheorySays) {
  const models::Setup base = setup_with({});
  const Errors before = twin_of(base, 15);
  const Errors before_theory = theory_of(base);
  struct Change {
    const char* name;
    std::vector<std::string> set;
  };
  for (const Change& change :
       {Change{"latency", {"truth.tracker.latency_ms=8.5"}},
        Change{"process", {"truth.tracker.process_ms=4.6"}},
        Change{"udp delay", {"truth.tracker.udp_delay_ms=4"}},
        Change{"bias", {"truth.tracker.bias_mm=[-0.05, 0, 0]"}},
        Change{"noise", {"truth.tracker.noise_mm=[0.25, 0, 0]"}},
        Change{"acceleration",
               {"truth.hexapod.acceleration_m_s2=1.5", "rig.manipulator.acceleration_m_s2=1.5"}},
        Change{"server rate", {"truth.tracker.server_rate_hz=240"}},
        Change{"tracker rate", {"truth.tracker.rate_hz=320"}}}) {
    const models::Setup setup = setup_with(change.set);
    const Errors after = twin_of(setup, 15);
    const Errors after_theory = theory_of(setup);
    const double moved = after.rmse - before.rmse;
    const double expected = after_theory.rmse - before_theory.rmse;
    EXPECT_GT(std::abs(expected), 0.015e-3) << change.name;  // the parameter matters
    EXPECT_NEAR(moved, expected, 0.12 * std::abs(expected) + 0.008e-3) << change.name;
  }
}

// Without every part of the chain the remaining error is rounding.
TEST(TrackingProperty, WithoutBiasNoiseDelayWaitAndStepTheErrorIsRounding) {
  const models::Setup setup = setup_with(
      {"travel.dwell_s=0.1", "truth.tracker.bias_mm=[0,0,0]", "truth.tracker.noise_mm=[0,0,0]",
       "truth.tracker.marker_noise_mm=0", "truth.tracker.latency_ms=0", "truth.tracker.process_ms=0",
       "truth.tracker.udp_delay_ms=0", "truth.tracker.clocks=\"aligned\"", "truth.tracker.rate_hz=1000",
       "truth.tracker.server_rate_hz=1000", "truth.hexapod.step_um=0", "truth.hexapod.repeatability_um=0"});
  const TravelErrors errors = run_travel(setup, 1, false);
  EXPECT_GT(errors.forward[0].size(), 1000);
  EXPECT_LT(errors.largest, 1e-9);
}

// `encounter calibrate tracker` on 100 seeded logs: it recovers the injected values, and its intervals
// contain them.

double figure(const BenchResult& result, const std::string& id) {
  const auto found = std::find_if(result.figures.begin(), result.figures.end(),
                                  [&](const Figure& f) { return f.id == "tracking.forensics." + id; });
  return found == result.figures.end() ? kUnset : found->twin;
}

TEST(Forensics, FindsWhatWasPutInto100Logs) {
  BenchContext context;
  context.models = tests::source_dir() + "/models";
  context.full = true;
  BenchResult result;
  add_forensics(context, result);
  EXPECT_GE(figure(result, "latency.percent"), 95.0) << "within 1 ms";
  EXPECT_GE(figure(result, "bias.percent"), 95.0) << "all axes within 0.01 mm";
  // Once in 1000 times fewer than 88 and 91 % of the 95 % intervals hold, for 100 and for 300 numbers.
  EXPECT_GE(figure(result, "latency_interval.percent"), 88.0);
  EXPECT_GE(figure(result, "bias_interval.percent"), 91.0);
  for (const Figure& f : result.figures) EXPECT_TRUE(f.ok()) << f.id << " " << f.twin;
  ASSERT_EQ(result.plots.size(), 1U);
  EXPECT_EQ(result.plots[0].series[1].x.size(), 100U);
}

// Each parameter alone: the fitted latency follows the injected latency; a bias and a noise do not move it.
TEST(Forensics, OnlyLatencyMovesLatency) {
  LogSpec spec;
  const auto found = [&](const LogSpec& s) { return models::fit_latency(made_log(s, 7).log); };
  const models::LatencyFit before = found(spec);
  LogSpec later = spec;
  later.tracker.latency += 0.005;
  EXPECT_NEAR(found(later).latency.value - before.latency.value, 0.005, 0.3e-3);
  LogSpec off = spec;
  off.tracker.bias.x() += 0.2e-3;
  EXPECT_NEAR(found(off).latency.value, before.latency.value, 0.05e-3);
  EXPECT_NEAR(found(off).axes[0].bias.value - before.axes[0].bias.value, 0.2e-3, 1e-6);
  LogSpec noisy = spec;
  noisy.tracker.noise = Vec3::Constant(0.05e-3);
  EXPECT_NEAR(found(noisy).latency.value, before.latency.value, 0.4e-3);
  EXPECT_NEAR(found(noisy).axes[1].noise, 0.05e-3, 0.003e-3);
  LogSpec lossy = spec;
  lossy.tracker.loss = 0.2;
  EXPECT_NEAR(found(lossy).latency.value, before.latency.value, 0.4e-3);
}

TEST(Forensics, TrueStampsAreFoundTrue) {
  LogSpec spec;
  spec.stamps = true;
  const MadeLog made = made_log(spec, 11);
  const models::LatencyFit fit = models::fit_latency(made.log);
  EXPECT_NEAR(fit.stamp_error.value, 0.0, 0.1e-3);
  EXPECT_NEAR(fit.stamp_age.value, made.latency, 0.3e-3);
}

}  // namespace
}  // namespace enc::bench::tracking
