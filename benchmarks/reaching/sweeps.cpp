// Gains and costs of another camera, another filter and finer steps of the physics: run by `--full`.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/statistics.h"
#include "benchmarks/reaching/reach_runs.h"

namespace enc::bench::reaching {
namespace {

constexpr int kEach = 10;  // reaches for each of two tilts: 20 have a p95

// Misses of a finger that comes obliquely with 200 mm/s, 20 and 40 degrees from the normal, p95, mm.
std::vector<double> misses_with(const BenchContext& context, const std::vector<Settings>& settings) {
  std::vector<ReachRun> runs;
  for (const Settings& set : settings)
    for (const double tilt : {20.0, 40.0})
      runs.push_back(steady_reaches(0.2, tilt, kEach, context.seed) + set);
  const std::vector<ReachResult> ran = run_all(context, runs);
  std::vector<double> p95;
  for (std::size_t i = 0; i < settings.size(); ++i)
    p95.push_back(1e3 * percentile(misses(joined({ran[2 * i], ran[2 * i + 1]})), 0.95));
  return p95;
}

// A camera of another rate (Hz) and latency (ms).
Settings camera(double rate, double latency) {
  return {fmt::format("truth.tracker.rate_hz={}", rate), fmt::format("truth.tracker.latency_ms={}", latency),
          fmt::format("rig.tracker.usual_age_ms={}", latency + 1e3 / rate + 10.0)};
}

// Share of the reaches for the wall with the prop in time, over the camera's latency, for each rate.
void camera_part(const BenchContext& context, BenchResult& result) {
  const std::vector<double> latency{5, 10, 20, 30, 50, 75, 100}, rate{20, 30, 60, 120};
  constexpr std::size_t kPeople = 5;
  std::vector<ReachRun> runs;
  for (const double ms : latency)
    for (const double hz : rate)
      for (std::size_t i = 0; i < kPeople; ++i)
        runs.push_back(random_reaches("wall", 12, context.seed + i) + camera(hz, ms));
  const std::vector<ReachResult> ran = run_all(context, runs);
  Plot plot{"reaching_camera", "Reaches for the wall with the prop in time", "latency of the camera (ms)",
            "in time (%)"};
  Table table{
      "reaching_camera", "Reaches for the wall with the prop in time (%), over the camera", {"latency (ms)"}};
  for (const double hz : rate) {
    plot.series.push_back({.name = fmt::format("{:.0f} Hz", hz), .mark = Mark::both});
    table.columns.push_back(fmt::format("{:.0f} Hz", hz));
  }
  auto from = ran.begin();
  for (const double ms : latency) {
    table.rows.push_back({fmt::format("{:g}", ms)});
    for (Series& series : plot.series) {
      series.add(ms, 100.0 * in_time(joined({from, from + kPeople})));
      table.rows.back().push_back(fixed(series.y.back(), 0));
      from += kPeople;
    }
  }
  plot.caption = table.note =
      "60 reaches for each camera, the same in all; noise 0.5 mm. The paper's camera has 20 Hz; its latency "
      "of "
      "50 ms is assumed.";
  table.printed = true;
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
}

// The filter's one number: if it is too small, the filter lags when the hand changes its speed; if too large,
// it passes noise on.
void filter_part(const BenchContext& context, BenchResult& result) {
  const std::vector<double> noise{0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0};
  std::vector<Settings> settings;
  std::vector<ReachRun> runs;
  for (const double q : noise) {
    settings.push_back({fmt::format("rig.tracker.acceleration_noise_m_s2_per_sqrt_hz={}", q)});
    for (const char* scene : {"wall", "reaching"})
      runs.push_back(random_reaches(scene, 25, context.seed) + settings.back());
  }
  const std::vector<ReachResult> ran = run_all(context, runs);
  Series random{"random reaches", noise};
  for (std::size_t i = 0; i < noise.size(); ++i)
    random.y.push_back(1e3 * percentile(misses(joined({ran[2 * i], ran[2 * i + 1]})), 0.95));
  random.mark = Mark::both;
  Plot plot{"reaching_filter",
            "Miss over the acceleration that the filter thinks possible",
            "acceleration noise (m/s^2/sqrt(Hz))",
            "miss, p95 (mm)",
            true,
            true};
  plot.series = {
      random, {.name = "even 200 mm/s", .x = noise, .y = misses_with(context, settings), .mark = Mark::both}};
  plot.caption =
      "An even approach wants a filter that averages long; a hand that slows down before the touch wants one "
      "that follows soon.";
  result.plots.push_back(std::move(plot));
}

struct Steps {
  std::string integrator;
  std::vector<double> timestep_us;
};

// Equal reaches with other steps of the physics: error of the impact against fine steps, over the run time.
void steps_part(const BenchContext& context, BenchResult& result) {
  const auto with = [&](const std::string& integrator, double us) {
    return steady_reaches(0.2, 20.0, kEach, context.seed) + seen(FingerTracking::live) +
           Settings{fmt::format("truth.arm.integrator=\"{}\"", integrator),
                    fmt::format("truth.arm.timestep_us={}", us)};
  };
  const std::vector<Steps> all{
      {"euler", {1000, 500, 250, 125}}, {"implicitfast", {1000, 500, 250, 125}}, {"rk4", {1000, 500, 250}}};
  std::vector<ReachRun> runs{with("rk4", 62.5)};
  for (const Steps& steps : all)
    for (const double us : steps.timestep_us) runs.push_back(with(steps.integrator, us));
  const std::vector<ReachResult> ran = run_all(context, runs);
  const std::vector<double> reference = impacts(ran[0].reaches);
  Plot plot{"reaching_steps",
            "Work and precision of the physics",
            "run time of a second (ms)",
            "error of the impact (%)",
            true,
            true};
  std::size_t next = 1;
  for (const Steps& steps : all) {
    Series series{steps.integrator};
    series.mark = Mark::both;
    for (std::size_t k = 0; k < steps.timestep_us.size(); ++k, ++next) {
      const std::vector<double> impact = impacts(ran[next].reaches);
      double sum = 0.0;
      const std::size_t n = std::min(impact.size(), reference.size());
      for (std::size_t i = 0; i < n; ++i) sum += std::abs(impact[i] / reference[i] - 1.0);
      series.add(1e3 * ran[next].seconds / ran[next].simulated, 100.0 * sum / static_cast<double>(n));
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "Mean error of the peak force of a touch at 200 mm/s against rk4 at 62.5 us; steps of 1000, 500, 250 "
      "(and 125) us from left to right. The haptic loop runs at 1 kHz in all.";
  result.plots.push_back(std::move(plot));
}

}  // namespace

void add_sweeps(const BenchContext& context, BenchResult& result) {
  camera_part(context, result);
  filter_part(context, result);
  steps_part(context, result);
}

}  // namespace enc::bench::reaching
