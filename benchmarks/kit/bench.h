// The result of a benchmark: figures, plots and tables. Other programs read results.json: keep its form
// (sources/choices 4).
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/context.h"
#include "benchmarks/kit/plot_data.h"
#include "core/base/frames.h"

namespace enc::bench {

// calibrated: the paper's value set a parameter. predicted: it did not. ours: no paper value exists.
enum class Role : std::uint8_t { calibrated, predicted, ours };

struct Figure {
  std::string id;         // first token the benchmark, last token the statistic (sources/choices 10)
  double paper = kUnset;  // unset: null
  double twin = kUnset;
  std::string unit;
  Role role = Role::ours;
  double low = kUnset, high = kUnset;  // bounds, both sides; unset: none
  std::string note;
  double least = kUnset, most = kUnset;  // over seeds or repeats, if there are several
  bool absent = false;  // not measurable here, such as the ground truth of a real machine: no bounds apply
  bool cost = false;    // a time, a ratio of times or memory: depends on the computer, never fails
  std::vector<double> values{};  // of each seed or repeat, in order, without those that have none
  [[nodiscard]] bool ok() const;
};

struct Table {
  std::string id;  // file name without ".csv"; begins with the benchmark's name
  std::string title;
  std::vector<std::string> columns;  // with their unit
  std::vector<std::vector<std::string>> rows{};
  std::string note{};
  bool printed = false;  // on the terminal, too
  std::string source{};  // lines about a data file, at the head of its CSV; the report leaves them out
  template <class... Cells>
  void add(const Cells&... cells) {
    rows.push_back({fmt::format("{}", cells)...});
  }
};

// A number of a table, with this many digits behind the point.
[[nodiscard]] inline std::string fixed(double value, int digits) {
  return fmt::format("{:.{}f}", value, digits);
}

struct Picture {
  std::string id, title, caption, png;  // id.png is its file; `png` the bytes
};

struct BenchResult {
  std::string name, scene;
  double run_time = 0.0, simulated = 0.0;  // s
  std::vector<Figure> figures;
  std::string note{};  // a note for the reader, such as omissions; may be empty
  std::vector<Plot> plots{};
  std::vector<Table> tables{};
  std::vector<Picture> pictures{};
};

}  // namespace enc::bench
