// With dry friction and encoder counts: does a device that is let go come to rest?
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/stability/stability.h"
#include "core/base/units.h"

namespace enc::bench::stability {
namespace {

constexpr Stepping kFine{Scheme::rk4, 10};

// Rubs as much as a small arm does.
Device rubbed(double damping, double delay) {
  Device device{0.1, damping, 1e-3, delay};
  device.friction = 0.05;
  device.count = 30e-6;
  return device;
}

struct Cell {
  Device device;
  double stiffness = 1000.0, x0 = 1e-3;
};
struct Judged {
  certificate::Rest predicted = certificate::Rest::unknown;
  Outcome outcome = Outcome::away;
};

Judged judge(const Cell& cell) {
  const Device& d = cell.device;
  return {certificate::release(loop_of(d), steps_of(d), cell.stiffness, 0.0, cell.x0).rest,
          let_go(d, {cell.stiffness, 0.0}, kFine, cell.x0)};
}

struct Grid {
  const char* name;
  double x0, stiffness, count;  // m, N/m, m
  double least, most;           // N s/m, of the damping: about what the boundary has
};
// One for each disturbance where it comes to rest for some; and one whose counts push more than friction
// holds (K step > 2 f_c): what is called still there goes on by less than 1 % of the disturbance.
constexpr Grid kGrids[] = {{"0.1mm", certificate::kSmall, 3000.0, 30e-6, 0.25, 16.0},
                           {"1mm", certificate::kLarge, 1000.0, 30e-6, 0.02, 8.0},
                           {"counts", certificate::kLarge, 1000.0, 150e-6, 0.02, 8.0}};

// Damping x delay at one stiffness, and which share of it is foretold.
void add_grid(Bench& bench, const Grid& grid) {
  std::vector<Cell> all;
  const int rows = bench.context.quick ? 7 : 12, columns = bench.context.quick ? 6 : 11;
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) {
      const double delay = 0.5e-3 * std::round(10.0 * k / (columns - 1));
      const double damping = grid.least * std::pow(grid.most / grid.least, i / (rows - 1.0));
      all.push_back({rubbed(damping, delay), grid.stiffness, grid.x0});
      all.back().device.count = grid.count;
    }
  const auto judged = bench.each(all, judge);
  Agreement agreed;
  double still = 0.0;
  Table table{fmt::format("regions_{}", grid.name),
              fmt::format("Let go {:g} mm beside the edge of a wall of {:g} N/mm, counts of {:g} um",
                          grid.x0 * kMmPerM, grid.stiffness * 1e-3, grid.count * 1e6),
              {"b (N s/m)", "delay (ms)", "foretold", "MuJoCo"}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const certificate::Rest found = same_as(judged[i].outcome), told = judged[i].predicted;
    agreed.see(told, found);
    still += found == certificate::Rest::still ? 1.0 : 0.0;
    table.add(fmt::format("{:.3g}", all[i].device.damping), fmt::format("{:g}", all[i].device.delay * 1e3),
              word_of(told), word_of(found));
  }
  const double share = 100.0 / static_cast<double>(all.size());
  const auto id = [&](const char* what) { return fmt::format("regions.{}.{}", grid.name, what); };
  bench.figure(id("agree"), agreed.rest * share, "%", at_least(95.0),
               fmt::format("of {} of damping x delay: rests or does not, as foretold", all.size()));
  bench.figure(id("same"), agreed.same * share, "%", at_least(95.0),
               "the same, with limit cycles told from what runs away");
  bench.figure(id("still"), still * share, "%", "of them rest");
  bench.table(std::move(table));
}

// A device that has all there is: well damped, with coarse counts, 2 f_c/step = 267 N/m below 2 b/T = 2000.
Device of_map(double delay) {
  Device device = rubbed(1.0, delay);
  device.friction = 0.02;
  device.count = 150e-6;
  return device;
}

std::vector<Series> bound_lines(const std::vector<double>& delays, double low, double high) {
  std::vector<Series> lines;
  for (const double delay : delays) {
    Device device = of_map(delay);
    device.hand_mass = 0.1;
    device.hand_damping = 4.0;
    device.hand_spring = 300.0;
    const auto rows = certificate::bounds(loop_of(device), steps_of(device), {1.0, {}});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto at = std::find_if(lines.begin(), lines.end(),
                                   [&](const Series& line) { return line.name == rows[i].name; });
      Series& line = at != lines.end() ? *at : lines.emplace_back(Series{.name = rows[i].name});
      line.x.push_back(delay * 1e3);
      line.y.push_back(rows[i].bound >= low && rows[i].bound <= high ? rows[i].bound : kUnset);
    }
  }
  return lines;
}

// Stiffness x delay, with all bounds.
void add_map(Bench& bench) {
  std::vector<Cell> all;
  std::vector<double> delays;
  const int columns = bench.context.quick ? 6 : 21, rows = bench.context.quick ? 9 : 15;
  delays.reserve(static_cast<std::size_t>(columns));
  for (int i = 0; i < columns; ++i) delays.push_back(1e-4 * std::round(100.0 * i / (columns - 1)));
  constexpr double kLow = 3.0, kHigh = 3e4;
  for (const double delay : delays)
    for (int k = 0; k < rows; ++k)
      all.push_back({of_map(delay), kLow * std::pow(kHigh / kLow, k / (rows - 1.0)), 1e-3});
  const auto found = bench.each(all, [](const Cell& c) {
    return static_cast<int>(let_go(c.device, {c.stiffness, 0.0}, kFine, c.x0));
  });
  Plot plot{.id = "map",
            .title = "A wall of stiffness and delay: what becomes of 1 mm",
            .x_label = "delay (ms)",
            .y_label = "stiffness (N/m)",
            .log_y = true};
  const char* const names[] = {"MuJoCo: rests", "limit cycle", "runs away", "not known"};
  for (int outcome = 0; outcome < 4; ++outcome) {
    Series points{.name = names[outcome], .mark = Mark::points};
    for (std::size_t i = 0; i < all.size(); ++i)
      if (found[i] == outcome) points.add(all[i].device.delay * 1e3, all[i].stiffness);
    if (outcome == 3 && points.x.empty()) continue;
    plot.series.push_back(std::move(points));
  }
  for (Series& line : bound_lines(delays, kLow, kHigh)) plot.series.push_back(std::move(line));
  plot.caption =
      "b 1 N s/m, 0.1 kg, T 1 ms, friction 0.02 N, counts of 150 um, nobody touches it. Up to exact_alone "
      "every "
      "swing dies out until counts are left; from abbott_okamura on these go on, and are drawn as a limit "
      "cycle "
      "where they are more than 1 % of the 1 mm. Up to friction_large friction stops what is unstable. "
      "exact_with_hand: with 0.1 kg, 4 N s/m, 300 N/m on it, which the points are without.";
  bench.plot(std::move(plot));
}

}  // namespace

void add_regions(Bench& bench) {
  for (const Grid& grid : kGrids) add_grid(bench, grid);
  add_map(bench);
}

}  // namespace enc::bench::stability
