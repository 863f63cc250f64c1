// The paper's machine is told each millisecond, over EtherCAT. Over GCS a set-point goes each ten or so: what
// does that do to a press of the ball, to Table 1, to Fig 3 and to Table 2?
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/indentation/indent_run.h"
#include "benchmarks/stiffness/push_study.h"
#include "benchmarks/tracking/table1.h"
#include "benchmarks/wires/parts.h"
#include "benchmarks/wires/wired_trial.h"
#include "core/base/units.h"
#include "hw_drivers/wires/tight_times.h"

namespace enc::bench::wires {
namespace {

constexpr std::array kStiffnesses{0.1, 0.3, 10.0};  // N/mm: where Fig 3 errs, where it begins to hold, stiff

// ms between set-points; 0: no wires.
struct Cycled {
  double simulated = 0.0;  // s
  bool held = false;
  Pressed press;
  double rmse_40 = kUnset;  // m, Table 1, x at 40 mm/s
  std::array<double, kStiffnesses.size()> felt{kUnset, kUnset, kUnset},
      swing{kUnset, kUnset, kUnset};             // %, m
  double pressing = kUnset, releasing = kUnset;  // N, Table 2, A
};

models::Setup on_fakes(const Bench& bench, const std::string& scene, int cycle,
                       std::vector<std::string> set) {
  set.push_back(fmt::format("rig.driver.gcs.cycle_ms={}", std::max(cycle, 1)));
  set.push_back(fmt::format("rig.driver.gcs.poll_ms={}", cycle > 1 ? 2 : 1));
  set.insert(set.end(), bench.context.set.begin(), bench.context.set.end());
  return models::load(bench.context.models + "/scenes/" + scene + ".toml", "fakes",
                      enc::wires::tight_times(std::move(set)));
}

// Runs `measure(options, setup)` with the devices of the set-up behind their wires, or without wires.
template <class Measure>
auto through(const models::Setup& setup, int cycle, const Measure& measure) {
  if (cycle == 0) return measure(trial::TrialOptions{}, setup);
  Laboratory laboratory(setup);
  return measure(laboratory.behind({}), laboratory.setup());
}

Cycled with_cycle(const Bench& bench, int cycle, std::uint64_t seed) {
  Cycled of;
  of.press = through(on_fakes(bench, "tennis_ball", cycle, {}), cycle,
                     [&](trial::TrialOptions options, const models::Setup& with) {
                       options.seed = seed;
                       options.seconds = kOnePress;
                       trial::Trial trial(with, std::move(options));
                       return pressed(trial);
                     });
  of.held = of.press.held;
  of.simulated += kOnePress;
  const models::Setup travel =
      on_fakes(bench, "tracking", cycle, {"travel.axes=\"x\"", "travel.speed_mm_s=40"});
  const tracking::TravelErrors errors =
      through(travel, cycle, [&](const trial::TrialOptions& options, const models::Setup& with) {
        return tracking::run_travel(with, seed, false, options);
      });
  of.simulated += errors.simulated;
  // What a run that held has measured is nothing: its machine is later than the core believes.
  if (errors.held.empty())
    of.rmse_40 = errors.forward[0].errors().rmse;
  else
    of.held = true;
  const models::Setup push =
      on_fakes(bench, "stiffness", cycle, {"rig.force.tare=start", "rig.contact.softest_N_per_mm=0"});
  for (std::size_t i = 0; i < kStiffnesses.size(); ++i) {
    const models::Setup one = stiffness::with_stiffness(push, kStiffnesses[i] * kNewtonPerMillimetre);
    const stiffness::Push felt =
        through(one, cycle, [&](const trial::TrialOptions& options, const models::Setup& with) {
          return stiffness::push_once(with, seed, nullptr, options);
        });
    of.simulated += stiffness::push_time(one);
    if (!felt.held.empty()) {
      of.held = true;
      continue;
    }
    of.felt[i] = felt.error(felt.measured);
    of.swing[i] = felt.peak_to_peak;
  }
  const models::Setup ball = on_fakes(bench, "indentation", cycle, indentation::indentations()[0].set);
  const indentation::IndentRun run =
      through(ball, cycle, [&](const trial::TrialOptions& options, const models::Setup& with) {
        return indentation::indent_run(with, seed, options);
      });
  of.pressing = indentation::errors_of(run.recorded.press, run.reference, true).rmse;
  of.releasing = indentation::errors_of(run.recorded.release, run.reference, false).rmse;
  of.simulated += run.simulated;
  return of;
}

}  // namespace

void add_cycles(Bench& bench) {
  std::vector<int> cycles{0, 1, 2, 5, 10, 20, 50};
  if (bench.context.quick) cycles = {0, 1, 10};
  const std::vector<Cycled> all =
      bench.each(cycles, [&](int cycle) { return with_cycle(bench, cycle, bench.context.seed); });
  const auto shown = [](const char* form, double x) {
    return std::isnan(x) ? std::string("held") : fmt::format(fmt::runtime(form), x);
  };
  const auto mm = [&](double x) { return shown("{:.3f}", 1e3 * x); };
  Table table{
      "cycles",
      "A set-point each so many milliseconds",
      {"cycle", "contacts of a press", "held", "peak, N", "Table 1, x, 40 mm/s, mm", "Fig 3, 0.1 N/mm, %",
       "0.3 N/mm, %", "10 N/mm, %", "swing at 0.1 N/mm, mm", "Table 2, A, press, N", "release, N"},
      {},
      "Rendered over commanded stiffness as in Fig 3, x without sign of its own in Table 1, errors of "
      "force as in Table 2; one seed. A swing of more than 1 mm is unstable.",
      true};
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const Cycled& of = all[i];
    table.add(cycles[i] == 0 ? "no wires" : fmt::format("{} ms", cycles[i]), of.press.contacts,
              of.held ? "yes" : "no", fmt::format("{:.2f}", of.press.peak), mm(of.rmse_40),
              shown("{:+.2f}", of.felt[0]), shown("{:+.2f}", of.felt[1]), shown("{:+.2f}", of.felt[2]),
              mm(of.swing[0]), shown("{:.4f}", of.pressing), shown("{:.4f}", of.releasing));
  }
  bench.table(std::move(table));
  const auto at = [&](int cycle) {
    return static_cast<std::size_t>(std::find(cycles.begin(), cycles.end(), cycle) - cycles.begin());
  };
  const Cycled &pure = all[0], &fast = all[at(1)], &usual = all[at(10)];
  bench.figure("peak.1.difference", std::abs(fast.press.peak - pure.press.peak), "N", at_most(0.2),
               "cycle of 1 ms against no wires");
  // The peak is where the ball's limit is, and would hide a machine that is late or turned.
  const auto apart = [&](const Cycled& of) {
    double sum = 0.0;
    const std::size_t n = std::min(of.press.height.size(), pure.press.height.size());
    for (std::size_t i = 0; i < n; ++i) sum += std::pow(of.press.height[i] - pure.press.height[i], 2);
    return std::sqrt(sum / static_cast<double>(n));
  };
  bench.figure("tip.1.rms", 1e3 * apart(fast), "mm", at_most(0.05), "of the tip's height, against no wires");
  bench.figure("tip.10.rms", 1e3 * apart(usual), "mm");
  bench.figure("touched.1.difference", 1e3 * std::abs(fast.press.touched - pure.press.touched), "ms",
               at_most(5.0), "when the first touch is noticed");
  bench.figure("peak.10.difference", std::abs(usual.press.peak - pure.press.peak), "N", at_most(0.2));
  bench.figure("contacts.1.count", fast.press.contacts, "", exactly(1));
  bench.figure("contacts.10.count", usual.press.contacts, "", exactly(1), "of one press");
  bench.figure("rmse.x.40.1.ratio", fast.rmse_40 / pure.rmse_40, "", between(0.95, 1.05),
               "Table 1 with a cycle of 1 ms over the same without wires");
  bench.figure("rmse.x.40.10.ratio", usual.rmse_40 / pure.rmse_40, "");
  bench.figure("felt.10.1.difference", std::abs(fast.felt[2] - pure.felt[2]), "%", at_most(0.5),
               "Fig 3 at 10 N/mm, cycle of 1 ms against no wires");
  bench.figure("felt.10.10.difference", std::abs(usual.felt[2] - pure.felt[2]), "%");
}

}  // namespace enc::bench::wires
