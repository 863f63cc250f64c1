// Is the haptic-tip there when the tool arrives? Miss at first touch over approach speed, many hands for each
// speed.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/bench.h"
#include "benchmarks/press_measure.h"
#include "benchmarks/statistics.h"

namespace enc::bench {
namespace {

constexpr std::array<double, 5> kSpeeds{0.010, 0.020, 0.050, 0.100, 0.200};  // m/s

void add_figures(BenchResult& result, double speed, const std::vector<double>& miss,
                 const std::vector<double>& delay, double bound) {
  const std::string id = fmt::format("encounter.miss.{:.0f}", speed * 1e3);
  const std::string note = fmt::format("{} seeds at {:.0f} mm/s; bound from rig and twin: {:.2f} mm",
                                       miss.size(), speed * 1e3, bound * 1e3);
  result.figures.push_back(
      {id + ".median", kUnset, median(miss) * 1e3, "mm", Role::ours, 0.0, bound * 1e3, note});
  result.figures.push_back({id + ".max", kUnset, *std::max_element(miss.begin(), miss.end()) * 1e3, "mm",
                            Role::ours, 0.0, bound * 1e3, note});
  result.figures.push_back({fmt::format("encounter.force_delay.{:.0f}.median", speed * 1e3), kUnset,
                            median(delay) * 1e3, "ms", Role::ours, kUnset, kUnset,
                            "from crossing the surface to the first contact force"});
}

}  // namespace

BenchResult run_encounter(const BenchContext& context) {
  BenchResult result{"encounter", "tennis_ball", 0, 0, {}};
  models::Setup setup = models::load(context.models + "/scenes/tennis_ball.toml", "sim", context.set);
  // A short press is enough: the figure is the meeting, not what follows.
  setup.scene.user->press_time = setup.scene.user->release_time = 0.8;
  setup.scene.user->hold_time = 0.1;
  setup.scene.user->depth = 0.002;
  const std::int64_t repeats = context.repeats > 0 ? context.repeats : (context.quick ? 5 : 40);
  double done = 0.0;
  for (const double speed : kSpeeds) {
    setup.scene.user->approach = {speed};
    std::vector<double> miss;
    std::vector<double> delay;
    for (std::int64_t i = 0; i < repeats; ++i) {
      const PressMeasure measure =
          measured_run(setup, context.seed + static_cast<std::uint64_t>(i), result.simulated);
      const PressFigures& press = measure.presses().front();
      if (!std::isnan(press.miss)) miss.push_back(press.miss);
      if (!std::isnan(press.first_force_delay)) delay.push_back(press.first_force_delay);
      done += 1.0 / (static_cast<double>(repeats) * kSpeeds.size());
      if (context.progress) context.progress(done);
    }
    if (!miss.empty()) add_figures(result, speed, miss, delay, miss_bound(setup, speed));
    result.figures.push_back({fmt::format("encounter.met.{:.0f}.percent", speed * 1e3), kUnset,
                              100.0 * static_cast<double>(delay.size()) / static_cast<double>(repeats), "%",
                              Role::ours, 100.0, 100.0, "presses in which tool and tip touched"});
  }
  return result;
}

}  // namespace enc::bench
