// Error against run time: what time step and integrator do to the critical stiffness, and what they cost.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/stability/maps.h"

namespace enc::bench::stability {
namespace {

constexpr std::array kStepCounts{1, 2, 5, 10, 20};  // of a period
constexpr double kTimedPeriod = 1e-3;               // s
constexpr int kTimedPeriods = 1000;                 // of a run that is timed

struct Setting {
  Scheme scheme;
  int steps;
  double delay;                          // s
  double error = kUnset, cost = kUnset;  // %; s of CPU for each second
  bool none = false;                     // stable for every stiffness: it failed
};

Device timed_device(double delay) { return {0.1, 0.2, kTimedPeriod, delay}; }

Setting timed(Setting s) {
  const Device device = timed_device(s.delay);
  const double exact = certificate::critical_stiffness(loop_of(device));
  const double found = critical(device, 0.0, {s.scheme, s.steps}, kUnset, 50.0 * exact);
  s.none = std::isinf(found);
  s.error = s.none ? kUnset : std::max(100.0 * std::abs(found / exact - 1.0), 1e-3);
  return s;
}

}  // namespace

void add_error_over_time(Bench& bench) {
  std::vector<Setting> all;
  for (const double delay : {0.0, 2e-3})
    for (const Scheme scheme : kSchemes)
      for (const int steps : kStepCounts) all.push_back({scheme, steps, delay});
  all = bench.each(all, timed);
  std::vector<std::function<void()>> ways;
  ways.reserve(all.size());
  for (const Setting& s : all)
    ways.emplace_back([&s] {
      Slide slide(timed_device(s.delay), {30.0, 0.0}, {s.scheme, s.steps}, 1e-3);
      for (int i = 0; i < kTimedPeriods; ++i) slide.period();
    });
  const Race race(bench.context.quick ? 3 : 5, ways);
  Table table{"work_precision",
              "Error of the critical stiffness against run time",
              {"integrator", "time step", "delay (ms)", "error (%)", "CPU s per s"}};
  std::vector<CostCurve> curves;
  Series chosen{.name = "default: rk4, a step a period", .mark = Mark::points, .paper = true};
  double error = 0.0, cost = kUnset, cheapest = kUnset;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Setting& s = all[i];
    s.cost = race.seconds(i) / (kTimedPeriods * kTimedPeriod);
    const bool first = s.steps == kStepCounts.front();
    if (first)
      curves.push_back({fmt::format("{}, {}", name_of(s.scheme), s.delay > 0.0 ? "2 ms late" : "in time")});
    curves.back().cost.push_back(s.cost);
    curves.back().error.push_back(s.error);
    table.add(name_of(s.scheme), first ? "T" : fmt::format("T/{}", s.steps), s.delay * 1e3,
              s.none ? "failed: stable for every stiffness" : fmt::format("{:.3g}", s.error),
              fmt::format("{:.3g}", s.cost));
    if (s.scheme == Scheme::rk4 && first) {
      chosen.add(s.cost, s.error);
      error = worse(error, s.error);
      if (s.delay == 0.0) cost = s.cost;
    } else if (s.error <= 3.0 && s.delay == 0.0 && !(cheapest < s.cost)) {
      cheapest = s.cost;
    }
  }
  Plot plot = cost_beside_error(
      {.id = "work_precision",
       .title = "Error of the critical stiffness against run time",
       .x_label = "CPU time for one second of experiment (s)",
       .y_label = "error of the critical stiffness (%)",
       .caption =
           "Time steps from a period (left) to a twentieth of it. Crosses: every stiffness seems stable. 3 % "
           "is what is asked; below 0.05 % the search for the boundary decides."},
      curves);
  plot.series.push_back(std::move(chosen));
  bench.plot(std::move(plot));
  bench.table(std::move(table));
  bench.figure("work_precision.error.max", error, "%", at_most(3.0),
               "critical stiffness at the default, rk4, a step a period");
  bench.cost("work_precision.default_over_cheapest.cpu", cost / cheapest, "x",
             "CPU time of the default over the cheapest other setting that is within 3 % without a delay");
}

}  // namespace enc::bench::stability
