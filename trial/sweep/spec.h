// The file of `encounter sweep`: a scene, the parameters that vary, the seeds, and the measures to keep
// (docs/guide/sweep.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/words.h"
#include "models/schema/toml_reader.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

enum class DesignKind : std::uint8_t { grid, random, sobol };
constexpr auto words(DesignKind) { return enum_words("grid", "random", "sobol"); }
enum class AxisScale : std::uint8_t { linear, log };
constexpr auto words(AxisScale) { return enum_words("linear", "log"); }

// One parameter that varies: a list of values, or a range.
struct Axis {
  std::string name;                 // as --set takes it
  std::vector<std::string> levels;  // as --set takes them; empty: a range
  double from = 0.0, to = 0.0;      // in the unit of the name
  std::int64_t steps = 0;           // grid only: values of the range
  AxisScale scale = AxisScale::linear;

  // The value at a share of the range, 0 to 1; of a list, the value whose part of 0 to 1 it is.
  [[nodiscard]] std::string at(double share) const;
};

// A run has the number point * seeds + repeat.
struct SweepSpec {
  std::string path;
  std::string scene, rig;  // rig: empty, the scene's own
  DesignKind design = DesignKind::grid;
  std::int64_t points = 0;  // random, sobol: given; grid: the product of all values
  std::int64_t seeds = 1;   // runs of each point
  double seconds = kUnset;  // length of a run; unset: to the end of its programme
  std::vector<Axis> axes;
  std::vector<std::string> keep;
  models::Places places;

  [[nodiscard]] std::int64_t runs() const { return points * seeds; }
};

inline constexpr std::int64_t kMostRuns = 10'000'000;

// Throws Error in one line with file, line and column.
[[nodiscard]] SweepSpec parse_sweep(const std::string& text, const std::string& path);
[[nodiscard]] SweepSpec load_sweep(const std::string& path);
// Checks the names and all values of lists and ends of ranges against the scene. Throws Error with the place.
void check_axes(const SweepSpec& spec, const models::Setup& setup);

// "file:line:column" of a key; without it, of the file's beginning.
[[nodiscard]] std::string place_in(const SweepSpec& spec, const std::string& key);

// The design as one text: two files with the same text have the same runs and seeds. The kept measures are
// not in it.
[[nodiscard]] std::string design_text(const SweepSpec& spec);
// Mixes every byte of a text into 64 bits.
[[nodiscard]] std::uint64_t text_hash(const std::string& text);

}  // namespace enc::trial
