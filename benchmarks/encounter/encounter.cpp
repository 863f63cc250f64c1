// Is the haptic-tip there when the tool arrives? Miss at first touch over approach speed, many hands for each
// speed.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/statistics.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::encounter {
namespace {

constexpr std::array<double, 5> kSpeeds{0.010, 0.020, 0.050, 0.100, 0.200};  // m/s

// What the hands of one speed met, m and s; NaN of those who never touched.
struct Met {
  std::vector<double> miss, delay;
  double simulated = 0.0;  // s
};

Met met(const models::Setup& setup, const BenchContext& context, std::int64_t repeats, double share) {
  const auto count = static_cast<std::size_t>(repeats);
  Met all{std::vector<double>(count), std::vector<double>(count)};
  std::vector<double> simulated(count);
  in_parallel(
      count,
      [&](std::size_t i) {
        const trial::PressMeasure measure = trial::measured_run(setup, context.seed + i, simulated[i]);
        all.miss[i] = measure.presses().front().miss;
        all.delay[i] = measure.presses().front().first_force_delay;
      },
      [&](double done) {
        if (context.progress) context.progress(share + done / kSpeeds.size());
      });
  for (const double s : simulated) all.simulated += s;
  const auto touched = [](std::vector<double>& values) {
    std::erase_if(values, [](double x) { return std::isnan(x); });
  };
  touched(all.miss);
  touched(all.delay);
  return all;
}

void add_figures(BenchResult& result, double speed, const Met& hands, double bound) {
  const std::string id = fmt::format("encounter.miss.{:.0f}", speed * 1e3);
  const std::string note = fmt::format("{} seeds at {:.0f} mm/s; bound from rig and twin: {:.2f} mm",
                                       hands.miss.size(), speed * 1e3, bound * 1e3);
  const auto [least, most] = std::minmax_element(hands.miss.begin(), hands.miss.end());
  const double middle = median(hands.miss) * 1e3;
  result.figures.push_back(
      {id + ".median", kUnset, middle, "mm", Role::ours, 0.0, bound * 1e3, note, *least * 1e3, *most * 1e3});
  result.figures.push_back({id + ".max", kUnset, *most * 1e3, "mm", Role::ours, 0.0, bound * 1e3, note});
  Series& misses = result.plots.front().series[0];
  Series& bounds = result.plots.front().series[1];
  misses.x.push_back(speed * 1e3);
  misses.y.push_back(middle);
  misses.low.push_back(*least * 1e3);
  misses.high.push_back(*most * 1e3);
  bounds.x.push_back(speed * 1e3);
  bounds.y.push_back(bound * 1e3);
  if (hands.delay.empty()) return;
  const auto [first, last] = std::minmax_element(hands.delay.begin(), hands.delay.end());
  result.figures.push_back({fmt::format("encounter.force_delay.{:.0f}.median", speed * 1e3), kUnset,
                            median(hands.delay) * 1e3, "ms", Role::ours, kUnset, kUnset,
                            "from crossing the surface to the first contact force", *first * 1e3,
                            *last * 1e3});
}

}  // namespace

BenchResult run(const BenchContext& context) {
  BenchResult result{"encounter", "tennis_ball", 0, 0, {}};
  models::Setup setup = load_scene(context, "tennis_ball");
  // A short press is enough: the figure is the meeting, not what follows.
  setup.scene.user->press_time = setup.scene.user->release_time = 0.8;
  setup.scene.user->hold_time = 0.1;
  setup.scene.user->depth = 0.002;
  const std::int64_t repeats = context.repeats > 0 ? context.repeats : (context.quick ? 5 : 40);
  result.plots.push_back(
      {"encounter.miss",
       "Tool tip to haptic-tip at first touch",
       "approach speed (mm/s)",
       "miss (mm)",
       true,
       true,
       {{"median, bars: least and most over seeds", {}, {}, {}, {}, Mark::both},
        {"bound from rig and twin", {}, {}}},
       "A miss must stay under the bound, which follows from the numbers of rig and twin alone."});
  double share = 0.0;
  for (const double speed : kSpeeds) {
    setup.scene.user->approach = {speed};
    const Met hands = met(setup, context, repeats, share);
    share += 1.0 / kSpeeds.size();
    result.simulated += hands.simulated;
    if (!hands.miss.empty()) add_figures(result, speed, hands, trial::miss_bound(setup, speed));
    result.figures.push_back({fmt::format("encounter.met.{:.0f}.percent", speed * 1e3), kUnset,
                              100.0 * static_cast<double>(hands.delay.size()) / static_cast<double>(repeats),
                              "%", Role::ours, 100.0, 100.0, "presses in which tool and tip touched"});
  }
  return result;
}

}  // namespace enc::bench::encounter
