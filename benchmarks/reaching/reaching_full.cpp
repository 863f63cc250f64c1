// What a better finger, another filter and finer steps of the physics would give, and what they cost.
#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "benchmarks/kit/statistics.h"
#include "benchmarks/reaching/reaching.h"

namespace enc::bench::reaching {
namespace {

constexpr int kEach = 10;  // for each of two tilts: 20 have a p95

// Of a finger that comes obliquely with 200 mm/s, 20 and 40 degrees from the normal, p95, mm.
std::vector<double> misses_with(const BenchContext& context, const std::vector<Settings>& settings) {
  std::vector<ReachRun> runs;
  for (const Settings& set : settings)
    for (const double tilt : {20.0, 40.0})
      runs.push_back(steady_reaches(0.2, tilt, kEach, context.seed) + set);
  const std::vector<ReachRan> ran = run_all(context, runs);
  std::vector<double> p95;
  for (std::size_t i = 0; i < settings.size(); ++i)
    p95.push_back(1e3 * percentile(misses(joined({ran[2 * i], ran[2 * i + 1]})), 0.95));
  return p95;
}

void vision_part(const BenchContext& context, BenchResult& result) {
  const std::vector<double> latency{0, 10, 25, 50, 75, 100}, rate{20, 60, 120};
  Plot plot{"reaching_vision",
            "Miss over the age of what is seen",
            "latency of the vision (ms)",
            "miss, p95 (mm)",
            false,
            false,
            {}};
  for (const double hz : rate) {
    std::vector<Settings> settings;
    settings.reserve(latency.size());
    for (const double ms : latency)
      settings.push_back({fmt::format("truth.tracker.rate_hz={}", hz),
                          fmt::format("truth.tracker.latency_ms={}", ms),
                          fmt::format("rig.tracker.usual_age_ms={}", ms + 1e3 / hz + 10.0)});
    plot.series.push_back(
        {fmt::format("{:.0f} Hz", hz), latency, misses_with(context, settings), {}, {}, Mark::both});
  }
  plot.caption =
      "Of a finger that comes with 200 mm/s, 20 and 40 degrees from the normal, with 0.5 mm noise.";
  result.plots.push_back(std::move(plot));
}

// The filter's one number: too small and it is late when the hand changes its speed, too large and it carries
// on noise.
void filter_part(const BenchContext& context, BenchResult& result) {
  const std::vector<double> noise{0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0};
  std::vector<Settings> settings;
  std::vector<ReachRun> runs;
  for (const double q : noise) {
    settings.push_back({fmt::format("rig.tracker.acceleration_noise_m_s2_per_sqrt_hz={}", q)});
    for (const char* scene : {"wall", "reaching"})
      runs.push_back(random_reaches(scene, 25, context.seed) + settings.back());
  }
  const std::vector<ReachRan> ran = run_all(context, runs);
  Series random{"random reaches", noise, {}};
  for (std::size_t i = 0; i < noise.size(); ++i)
    random.y.push_back(1e3 * percentile(misses(joined({ran[2 * i], ran[2 * i + 1]})), 0.95));
  random.mark = Mark::both;
  Plot plot{"reaching_filter",
            "Miss over the acceleration that the filter thinks possible",
            "acceleration noise (m/s^2/sqrt(Hz))",
            "miss, p95 (mm)",
            true,
            true,
            {}};
  plot.series = {random, {"even 200 mm/s", noise, misses_with(context, settings), {}, {}, Mark::both}};
  plot.caption =
      "An even approach wants a filter that averages long; a hand that slows down before the touch wants one "
      "that "
      "follows soon.";
  result.plots.push_back(std::move(plot));
}

struct Steps {
  std::string integrator;
  std::vector<double> timestep_us;
};

// Same reaches, the physics stepped otherwise: error of the impact against fine steps, over the run time.
void steps_part(const BenchContext& context, BenchResult& result) {
  const auto with = [&](const std::string& integrator, double us) {
    return steady_reaches(0.2, 20.0, kEach, context.seed) + seen(Seen::live) +
           Settings{fmt::format("truth.arm.integrator=\"{}\"", integrator),
                    fmt::format("truth.arm.timestep_us={}", us)};
  };
  const std::vector<Steps> all{
      {"euler", {1000, 500, 250, 125}}, {"implicitfast", {1000, 500, 250, 125}}, {"rk4", {1000, 500, 250}}};
  std::vector<ReachRun> runs{with("rk4", 62.5)};
  for (const Steps& steps : all)
    for (const double us : steps.timestep_us) runs.push_back(with(steps.integrator, us));
  const std::vector<ReachRan> ran = run_all(context, runs);
  const std::vector<double> reference = impacts(ran[0].reaches);
  Plot plot{"reaching_steps",
            "Work and precision of the physics",
            "run time of a second (ms)",
            "error of the impact (%)",
            true,
            true,
            {}};
  std::size_t next = 1;
  for (const Steps& steps : all) {
    Series series{steps.integrator, {}, {}};
    series.mark = Mark::both;
    for (std::size_t k = 0; k < steps.timestep_us.size(); ++k, ++next) {
      const std::vector<double> impact = impacts(ran[next].reaches);
      double sum = 0.0;
      const std::size_t n = std::min(impact.size(), reference.size());
      for (std::size_t i = 0; i < n; ++i) sum += std::abs(impact[i] / reference[i] - 1.0);
      series.x.push_back(1e3 * ran[next].seconds / ran[next].simulated);
      series.y.push_back(100.0 * sum / static_cast<double>(n));
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "Mean error of the peak force of a touch at 200 mm/s against rk4 at 62.5 us; steps of 1000, 500, 250 "
      "(and 125) us "
      "from left to right. The haptic loop runs at 1 kHz in all.";
  result.plots.push_back(std::move(plot));
}

}  // namespace

void add_reaching_full(const BenchContext& context, BenchResult& result) {
  vision_part(context, result);
  filter_part(context, result);
  steps_part(context, result);
}

}  // namespace enc::bench::reaching
