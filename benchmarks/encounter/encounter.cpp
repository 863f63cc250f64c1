// Miss at first touch over approach speed, many hands for each speed: is the haptic-tip there when the tool
// arrives?
#include <array>

#include <fmt/format.h>

#include "benchmarks/encounter/follow.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/kit/mutants.h"
#include "benchmarks/kit/precision.h"
#include "core/base/units.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::encounter {
namespace {

constexpr std::array<double, 5> kSpeeds{0.010, 0.020, 0.050, 0.100, 0.200};  // m/s

struct TouchResult {
  double miss = kUnset, delay = kUnset;  // m, s: values of a hand that touched
  double simulated = 0.0;                // s
};

TouchResult meet(models::Setup setup, double speed, std::uint64_t seed) {
  setup.scene.user->approach = {speed};
  TouchResult meeting;
  const trial::PressMeasure measure = trial::measured_run(setup, seed, meeting.simulated);
  meeting.miss = measure.presses().front().miss;
  meeting.delay = measure.presses().front().first_force_delay;
  return meeting;
}

// A short press is enough: the figure is about the first touch, not what follows.
models::Setup short_press(const Bench& bench) {
  models::Setup setup = bench.setup();
  UserSpec& user = *setup.scene.user;
  user.press_time = user.release_time = 0.8;
  user.hold_time = 0.1;
  user.depth = 0.002;
  return setup;
}

void run(Bench& bench) {
  const models::Setup setup = short_press(bench);
  const std::size_t hands = bench.context.count(40, 5);
  const auto meetings =
      bench.grid(kSpeeds, hands, [&](double speed, std::uint64_t seed) { return meet(setup, speed, seed); });
  Series misses{.name = "median, bars: least and most over seeds", .mark = Mark::both},
      bounds{.name = "bound from rig and twin"};
  for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
    const auto id = [&](const char* what, const char* statistic) {
      return fmt::format("{}.{:.0f}.{}", what, kSpeeds[i] * 1e3, statistic);
    };
    const std::vector<double> touched = known(meetings[i], &TouchResult::miss);
    const std::vector<double> delays = known(meetings[i], &TouchResult::delay);
    const Value miss = median_of(touched) * kMmPerM;
    const double bound = trial::miss_bound(setup, kSpeeds[i]) * kMmPerM;
    const std::string note = fmt::format("{} seeds at {:.0f} mm/s; bound from rig and twin: {:.2f} mm",
                                         touched.size(), kSpeeds[i] * 1e3, bound);
    bench.figure(id("miss", "median"), miss, "mm", between(0.0, bound), note);
    bench.figure(id("miss", "max"), miss.most, "mm", between(0.0, bound), note);
    bench.figure(id("force_delay", "median"), median_of(delays) * 1e3, "ms",
                 "from crossing the surface to the first contact force");
    bench.figure(id("met", "percent"),
                 100.0 * static_cast<double>(delays.size()) / static_cast<double>(hands), "%", exactly(100.0),
                 "presses in which tool and tip touched");
    misses.add(kSpeeds[i] * kMmPerM, miss);
    bounds.add(kSpeeds[i] * kMmPerM, bound);
  }
  bench.plot(
      {.id = "miss",
       .title = "Tool tip to haptic-tip at first touch",
       .x_label = "approach speed (mm/s)",
       .y_label = "miss (mm)",
       .log_x = true,
       .log_y = true,
       .series = {misses, bounds},
       .caption = "A miss must stay under the bound, which follows from the numbers of rig and twin alone."});
  add_follow(bench);
  add_force_precision(bench, {"user.approach_mm_s=[50]", "user.approach_from_mm=20", "user.press_s=0.8",
                              "user.hold_s=0.1", "user.release_s=0.8", "user.depth_mm=2"});
}

const Mutants kMutants{"encounter",
                       {{.what = "machine 15 mm beside where it is believed; a tip twice as fast; no pause",
                         .set = {"truth.hexapod.misplaced_mm=[15,0,0]"},
                         .changes = {"tip_twice_as_fast", "never_pauses"},
                         .kills = {"miss.*.median", "miss.*.max", "met.*.percent", "follow.behind.*",
                                   "follow.top_speed.*", "follow.pause_saves.percent"}}}};
const Reads kReads{"encounter", {.scenes = {"tennis_ball", "plane"}}};
const Entry kEntry{"encounter", "tennis_ball",
                   "distance from the true tool tip to the haptic-tip at first touch, over approach speed",
                   run};

}  // namespace
}  // namespace enc::bench::encounter
