// Table 2 over the press time, and what sets it: lag x speed x slope.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/indentation/indentation.h"
#include "benchmarks/kit/parallel.h"
#include "core/control/track/minimum_jerk.h"

namespace enc::bench::indentation {
namespace {

models::Setup with_time(models::Setup setup, double time) {
  setup.scene.user->press_time = setup.scene.user->release_time = time;
  return setup;
}

}  // namespace

// The servo's way lags by 2 zeta / omega. The command limiter takes a cycle, and what a command does is read
// in the next one.
double recorded_lag(const models::Setup& setup) {
  const sim::TwinSpec& twin = setup.twin;
  return 2.0 * twin.hexapod.damping / (2.0 * std::numbers::pi * twin.hexapod.servo) +
         (static_cast<double>(twin.hexapod.delay_cycles) + 2.0) / setup.rig.loop.rate;
}
double sensor_lag(const models::Setup& setup) {
  return recorded_lag(setup) + 1.0 / (2.0 * std::numbers::pi * setup.rig.force.filter);
}

double predicted_rmse(const LagTheory& theory, double time) {
  constexpr int kSteps = 4000;
  constexpr double kNear = 0.05e-3;  // m, as in split()
  constexpr double kWay = 1e-6;      // m, for the slope
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < kSteps; ++i) {
    const MinimumJerk at((i + 0.5) / kSteps);
    const double d = theory.depth * at.x;
    if (d >= theory.felt.limit() - kNear) break;
    const double speed = theory.depth * at.v / time;
    const double slope = (theory.felt.press(d + kWay) - theory.felt.press(std::max(0.0, d - kWay))) /
                         (kWay + std::min(d, kWay));
    const double e =
        theory.threshold + theory.lag * speed * slope + theory.felt.press(d) - theory.reference.press(d);
    sum += e * e;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kUnset;
}

namespace {

// A still hand presses in the scene's press time and in half of it.
void add_lag(const IndentStudy& study, BenchResult& result) {
  const models::Setup setup =
      indent_setup(study.context.models, indentations().front(), still_hand(), study.context.set);
  const double time = setup.scene.user->press_time;
  std::array<IndentRun, 2> runs;
  in_parallel(runs.size(), [&](std::size_t i) {
    models::Setup one = with_time(setup, i == 0 ? time : 0.5 * time);
    one.scene.user->release_time = 1.0;  // is not looked at
    runs[i] = indent_run(one, study.seed);
  });
  const BehaviourSpec& behaviour = setup.scene.behaviours.front();
  LagTheory theory{Response(behaviour.curves, 0.0, behaviour.reversal), Response(behaviour.curves, 0.0),
                   setup.scene.user->depth, setup.rig.force.threshold, kUnset};
  struct Way {
    const char* name;
    Reading reading;
    double lag, low, high;
  };
  for (const Way& way : {Way{"lag", Reading::recorded, recorded_lag(setup), 0.85, 1.15},
                         Way{"lag.sensor", Reading::sensor, sensor_lag(setup), kUnset, kUnset}}) {
    theory.lag = way.lag;
    const double slow = cell_of({runs[0]}, way.reading, true).rmse;
    const double fast = cell_of({runs[1]}, way.reading, true).rmse;
    const double predicted = predicted_rmse(theory, 0.5 * time) - predicted_rmse(theory, time);
    result.figures.push_back(
        {fmt::format("indentation.{}.ratio", way.name), kUnset, (fast - slow) / predicted, "", Role::ours,
         way.low, way.high,
         fmt::format(
             "RMSE of A's press grows from {:.4f} to {:.4f} N in {:g} instead of {:g} s; over what {:.1f} ms "
             "x speed x slope predict, {:.4f} N",
             slow, fast, 0.5 * time, time, way.lag * 1e3, predicted)});
  }
  for (const IndentRun& run : runs) result.simulated += run.simulated;
}

void add_sweep(const IndentStudy& study, BenchResult& result) {
  const std::vector<double> times =
      study.context.quick ? std::vector<double>{4.0} : std::vector<double>{3.0, 4.0, 6.0, 9.0, 13.5};
  const std::size_t each = study.context.quick ? 1 : 2;
  Plot plot{"indentation_press_time",
            "Table 2 over the press time, which the paper does not give",
            "press time (s)",
            "RMSE (N)",
            true,
            false,
            {}};
  Table table{"indentation_press_time",
              plot.title,
              {"press time (s)"},
              {},
              "Means of the logarithms' squares over the "
              "cells that are consistent: misfit."};
  for (const PaperCell& cell : study.paper) {
    if (cell.consistent)
      plot.series.push_back({fmt::format("paper, {} {}", cell.indentation, cell.way),
                             {times.front(), times.back()},
                             {cell.rmse, cell.rmse},
                             {},
                             {},
                             Mark::line,
                             true});
    table.columns.push_back(fmt::format("{} {} (N)", cell.indentation, cell.way));
  }
  table.columns.emplace_back("misfit (%)");
  std::vector<Series> lines;
  for (const PaperCell& cell : study.paper)
    lines.push_back({fmt::format("{} {}", cell.indentation, cell.way), {}, {}, {}, {}, Mark::both});
  for (const double time : times) {
    std::vector<std::vector<IndentRun>> runs;
    for (const Indentation& which : indentations())
      runs.push_back(
          indent_runs(with_time(indent_setup(study.context.models, which, {}, study.context.set), time),
                      study.seed, each));
    const std::vector<Cell> cells = cells_of(runs, Reading::recorded);
    std::vector<std::string> row{fmt::format("{:g}", time)};
    double misfit = 0.0, count = 0.0;
    for (std::size_t i = 0; i < kCells; ++i) {
      lines[i].x.push_back(time);
      lines[i].y.push_back(cells[i].rmse);
      row.push_back(fmt::format("{:.4f}", cells[i].rmse));
      if (!study.paper[i].consistent) continue;
      misfit += std::pow(std::log(cells[i].rmse / study.paper[i].rmse), 2);
      count += 1.0;
    }
    row.push_back(fmt::format("{:.1f}", 100.0 * std::sqrt(misfit / count)));
    table.rows.push_back(std::move(row));
    for (const std::vector<IndentRun>& of : runs)
      for (const IndentRun& run : of) result.simulated += run.simulated;
  }
  for (Series& line : lines) plot.series.push_back(std::move(line));
  plot.caption =
      "Slower presses have less lag; what remains is the force threshold and how far the law that is felt "
      "lies from the "
      "polynomials. Press time and release time alike.";
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
}

}  // namespace

void add_press_time(const IndentStudy& study, BenchResult& result) {
  add_sweep(study, result);
  add_lag(study, result);
}

}  // namespace enc::bench::indentation
