// The plots of a benchmark.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/base/frames.h"

namespace enc::bench {

// A number, or the middle of several with their least and their most.
struct Value {
  double middle = kUnset, least = kUnset, most = kUnset;
  std::vector<double> values{};         // all of them, in the order of their seeds
  Value(double only) : middle(only) {}  // NOLINT(google-explicit-constructor): a number is a value
  Value(double of, double from, double to, std::vector<double> all = {})
      : middle(of), least(from), most(to), values(std::move(all)) {}
};
[[nodiscard]] inline Value operator*(Value v, double by) {
  for (double& x : v.values) x *= by;
  return {v.middle * by, v.least * by, v.most * by, std::move(v.values)};
}

// The kind of a series. `low` and `high` are error bars or the edges of a band; empty: none. A NaN is a gap.
// `crosses` mark failures, such as an unstable run, and draw a NaN at the upper edge. `cells` are fields of a
// map, each as wide as half of the distance to its neighbours.
enum class Mark : std::uint8_t { line, points, both, bars, band, crosses, cells };
struct Series {
  std::string name;
  std::vector<double> x{}, y{};
  std::vector<double> low{}, high{};
  Mark mark = Mark::line;
  bool paper = false;                        // the paper's own values: one look in every plot
  std::size_t panel = 0;                     // index of its panel in Plot::panels
  void add(double at, const Value& value) {  // adds a point, with a bar if the value has one
    x.push_back(at);
    y.push_back(value.middle);
    if (std::isnan(value.least) && low.empty()) return;
    low.resize(x.size(), kUnset);
    high.resize(x.size(), kUnset);
    low.back() = value.least;
    high.back() = value.most;
  }
};
struct Plot {
  std::string id;                       // file name without ".svg"; begins with the benchmark's name
  std::string title, x_label, y_label;  // labels with their unit
  bool log_x = false, log_y = false;
  std::vector<Series> series{};
  std::string caption{};               // points out the result
  std::vector<std::string> x_names{};  // under x = 0, 1, 2, ... in place of numbers
  bool equal = false;                  // one unit of x is as long as one of y (maps)
  std::vector<std::string> y_names{};  // beside y = 0, 1, 2, ... from the top down, in place of numbers
  // Small multiples: a title for each, row by row. All share the axes, and a series name has one look in all
  // panels.
  std::vector<std::string> panels{};
  std::size_t columns = 1;
};
}  // namespace enc::bench
