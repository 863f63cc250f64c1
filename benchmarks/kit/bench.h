// What a benchmark gives: figures, plots and tables. results.json is read by others: keep its form
// (sources/choices 4).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/plot_data.h"
#include "core/base/frames.h"
#include "core/devices/module.h"

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
  double least = kUnset, most = kUnset;  // over seeds or repeats, where there are several
  bool absent = false;  // nobody can know it here, such as the truth of a real machine: nothing to hold
  bool cost = false;    // a time, a ratio of times or memory: it hangs on the machine, and informs
  [[nodiscard]] bool ok() const;
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

// A number of a table, with so many digits behind the point.
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
  // Over the devices of a rig (scenes.h); empty: in the twin.
  std::string rig{};
  bool armed = false, lockstep = false, fakes = false;
  bool not_real_time = false;  // a machine moves although the system refuses that
  // Called before a machine that somebody attends moves for the first time. Throws Error where it must not.
  std::function<void(const std::string& question)> confirm{};
  std::function<bool()> stop{};  // asked by whatever runs there: true ends it
  // How many seeds or laps: what the user says, else the benchmark's own.
  [[nodiscard]] std::size_t count(std::size_t own, std::size_t if_quick) const {
    if (repeats > 0) return static_cast<std::size_t>(repeats);
    return quick ? if_quick : own;
  }
};

// The table of benchmarks. Each one puts itself there, by one line in its own file:
//   const Entry kEntry{"speed", "tennis_ball", "step(), times real time", run};

class Bench;

struct Benchmark {
  const char* name;   // of its folder, too; first token of its figures' ids
  const char* scene;  // in models/scenes or models/rigs, without ".toml"; else what is measured: no --set
  const char* what;   // one line
  void (*run)(Bench&);
  void (*over_rig)(Bench&) = nullptr;  // the same over the devices of a rig; null: the twin alone
};

class Entry {
 public:
  Entry(const char* name, const char* scene, const char* what, void (*run)(Bench&),
        void (*over_rig)(Bench&) = nullptr);
};

[[nodiscard]] std::span<const Benchmark> benchmarks();  // by name
// In the twin, or over the devices of the context's rig.
[[nodiscard]] BenchResult result_of(const Benchmark& benchmark, const BenchContext& context);

}  // namespace enc::bench
