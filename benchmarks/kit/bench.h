// What a benchmark gives: figures, plots and tables. results.json is read by others: keep its form
// (sources/choices 4).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/frames.h"
#include "core/module.h"

namespace enc::bench {

inline constexpr double kMm = 1e3;  // per m

// calibrated: the paper's value set a parameter. predicted: it did not. ours: no paper value exists.
enum class Role : std::uint8_t { calibrated, predicted, ours };

// A number, or the middle of several with the least and the most of them.
struct Value {
  double middle = kUnset, least = kUnset, most = kUnset;
  Value(double only) : middle(only) {}  // NOLINT(google-explicit-constructor): a number is a value
  Value(double of, double from, double to) : middle(of), least(from), most(to) {}
};
[[nodiscard]] inline Value operator*(const Value& v, double by) {
  return {v.middle * by, v.least * by, v.most * by};
}

struct Figure {
  std::string id;         // first token the benchmark, last token the statistic (sources/choices 10)
  double paper = kUnset;  // unset: null
  double twin = kUnset;
  std::string unit;
  Role role = Role::ours;
  double low = kUnset, high = kUnset;  // bounds, both sides; unset: none
  std::string note;
  double least = kUnset, most = kUnset;  // over seeds or repeats, where there are several
  [[nodiscard]] bool ok() const;
};

// What the report draws. `low` and `high` are error bars or the edges of a band; empty: none. A NaN is a gap;
// of `crosses` (what failed, such as an unstable run) it is drawn at the upper edge.
enum class Mark : std::uint8_t { line, points, both, bars, band, crosses };
struct Series {
  std::string name;
  std::vector<double> x{}, y{};
  std::vector<double> low{}, high{};
  Mark mark = Mark::line;
  bool paper = false;                        // the paper's own values: drawn alike in every plot
  void add(double at, const Value& value) {  // a point, with a bar where the value has one
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
  std::string caption{};               // what to see in it
  std::vector<std::string> x_names{};  // under x = 0, 1, 2, ... in place of numbers
  bool equal = false;                  // one unit of x is as long as one of y (maps)
  std::vector<std::string> y_names{};  // beside y = 0, 1, 2, ... from the top down, in place of numbers
};
struct Table {
  std::string id;  // file name without ".csv"; begins with the benchmark's name
  std::string title;
  std::vector<std::string> columns;  // with their unit
  std::vector<std::vector<std::string>> rows{};
  std::string note{};
  bool printed = false;  // on the terminal, too
  std::string source{};  // of a data file: lines about it, which begin its CSV; the report leaves it out
  template <class... Cells>
  void add(const Cells&... cells) {
    rows.push_back({fmt::format("{}", cells)...});
  }
};

struct Picture {
  std::string id, title, caption, png;  // id.png is its file; `png` the bytes
};

struct BenchResult {
  std::string name, scene;
  double run_time = 0.0, simulated = 0.0;  // s
  std::vector<Figure> figures;
  std::string note{};  // for the reader, such as what was left out; may be empty
  std::vector<Plot> plots{};
  std::vector<Table> tables{};
  std::vector<Picture> pictures{};
};

struct BenchContext {
  std::string models;  // folder
  std::uint64_t seed = 1;
  std::int64_t repeats = 0;  // 0: the benchmark's own
  bool quick = false;
  bool full = false;  // also what takes minutes: switch-off tables, work-precision
  std::vector<std::string> set;
  std::function<void(double)> progress;  // share done; any thread may call it
  // Loads a module of the program by name; null where it was not built.
  std::function<const ModuleInfo*(const std::string&)> module{};
  // How many seeds or laps: what the user says, else the benchmark's own.
  [[nodiscard]] std::size_t count(std::size_t own, std::size_t if_quick) const {
    if (repeats > 0) return static_cast<std::size_t>(repeats);
    return quick ? if_quick : own;
  }
};

}  // namespace enc::bench
