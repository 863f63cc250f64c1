// Tools for writing a benchmark: its scene, runs over values and seeds, a line for each figure, plots.
// docs/guide/benchmark.md explains it; benchmarks/encounter is an example.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/scenes.h"
#include "benchmarks/kit/statistics.h"

namespace enc::bench {

// The bounds of a figure; a bound that is not given always holds.
struct Bounds {
  double low = kUnset, high = kUnset;
};
[[nodiscard]] constexpr Bounds at_least(double low) { return {low, kUnset}; }
[[nodiscard]] constexpr Bounds at_most(double high) { return {kUnset, high}; }
[[nodiscard]] constexpr Bounds between(double low, double high) { return {low, high}; }
[[nodiscard]] constexpr Bounds exactly(double value) { return {value, value}; }

// The paper's value, and whether it set a parameter.
struct Paper {
  double value;
  Role role;
};
[[nodiscard]] constexpr Paper calibrated(double value) { return {value, Role::calibrated}; }
[[nodiscard]] constexpr Paper predicted(double value) { return {value, Role::predicted}; }

// The context of a benchmark: the user's options and the place of its results. Ids of figures, plots and
// tables are given without the benchmark's name, which Bench puts in front.
class Bench {
 public:
  Bench(const Benchmark& benchmark, const BenchContext& given)
      : context(given), result{benchmark.name, benchmark.scene, 0, 0, {}} {}

  const BenchContext& context;
  BenchResult result;

  // The benchmark's own scene: scenes.h.
  [[nodiscard]] models::Setup setup(std::vector<std::string> own = {},
                                    const std::vector<std::string>& held = {}) const {
    return load_scene(context, result.scene, std::move(own), held);
  }
  void progress(double share) const {
    if (context.progress) context.progress(share);
  }
  [[nodiscard]] std::vector<std::uint64_t> seeds(std::size_t count) const;  // starts at the user's seed

  // Runs measure(x) for each value on all cores; results keep their order. Sums up seconds in a member
  // `simulated`. The first call reports progress: give it the longest part.
  template <class X, class Measure>
  auto each(const std::vector<X>& all, const Measure& measure) {
    using Cell = std::invoke_result_t<Measure, const X&>;
    static_assert(!std::is_same_v<Cell, bool>, "cells of vector<bool> share bytes");
    std::vector<Cell> cells(all.size());
    in_parallel(
        all.size(), [&](std::size_t i) { cells[i] = measure(all[i]); },
        std::exchange(tells_, false) ? context.progress : nullptr);
    if constexpr (requires(Cell cell) { cell.simulated; })
      for (const Cell& cell : cells) result.simulated += cell.simulated;
    return cells;
  }

  // Runs measure(value, seed) for each value with `seeds` seeds: [value][seed].
  template <class Values, class Measure>
  auto grid(const Values& values, std::size_t count, const Measure& measure) {
    std::vector<std::pair<typename Values::value_type, std::uint64_t>> all;
    for (const auto& value : values)
      for (const std::uint64_t seed : seeds(count)) all.emplace_back(value, seed);
    const auto cells = each(all, [&](const auto& x) { return measure(x.first, x.second); });
    std::vector<std::decay_t<decltype(cells)>> rows;
    for (std::size_t i = 0; i < all.size(); i += count)
      rows.emplace_back(cells.begin() + static_cast<std::ptrdiff_t>(i),
                        cells.begin() + static_cast<std::ptrdiff_t>(i + count));
    return rows;
  }

  // Figures of ours, without and with bounds; and beside the paper's.
  void figure(const std::string& id, const Value& twin, const char* unit, std::string note = {});
  void figure(const std::string& id, const Value& twin, const char* unit, Bounds bounds,
              std::string note = {});
  void figure(const std::string& id, const Value& twin, const char* unit, const Paper& paper, Bounds bounds,
              std::string note = {});
  // A time, a ratio of times or memory. Such a figure depends on the load of the computer, so it has no
  // bounds. Only a ratio of times of one run that holds on a busy machine with room to spare may have bounds
  // (docs/reference/report.md).
  void cost(const std::string& id, const Value& twin, const char* unit, std::string note = {});
  void cost(const std::string& id, const Value& twin, const char* unit, Bounds bounds, std::string note = {});
  // Marks a figure as not measurable here, because it needs the simulator's ground truth.
  void absent(const std::string& id, const char* unit, std::string note);
  void plot(Plot plot);
  void table(Table table);
  void picture(Picture picture);

 private:
  bool tells_ = true;
};

// One member of all cells, without the cells that have none (NaN).
template <class Cell>
[[nodiscard]] std::vector<double> known(const std::vector<Cell>& cells, double Cell::*member) {
  std::vector<double> values;
  for (const Cell& cell : cells)
    if (!std::isnan(cell.*member)) values.push_back(cell.*member);
  return values;
}
[[nodiscard]] Value median_of(const std::vector<double>& values);  // has least, most and all; NaN if empty

}  // namespace enc::bench
