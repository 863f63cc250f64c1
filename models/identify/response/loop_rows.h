// The rows of a measured loop, and the rows of each press: approach, press, retreat.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

struct LoopRow {
  double time = 0.0;        // s
  double deflection = 0.0;  // m, as in the file
  double force = kUnset;    // N, as in the file; unset: missing, which is allowed only outside of a press
  std::int64_t repeat = 0;  // 0: outside of a press
  // Line of the row in the file.
  std::size_t line = 0;
};

// Indices of rows, ends included. The approach is `from` to `deepest`, the retreat `deepest` to `to`. Rows
// between two presses may belong to the retreat of the first and to the approach of the second.
struct PressRows {
  std::size_t first = 0, last = 0;  // marked as this press
  std::size_t deepest = 0;
  std::size_t from = 0, to = 0;
};

// Presses in order of time. A press has one number of `repeat`; if the force falls to zero and rises again
// under one number, these are two presses.
[[nodiscard]] std::vector<PressRows> presses_in(std::span<const LoopRow> rows);

// Standard deviation of a position, m, from second differences, which vanish for a steady motion.
[[nodiscard]] double position_noise(std::span<const double> positions);

// Replaces each value by the median of it and its neighbours if it lies outside of them: removes single
// spikes.
[[nodiscard]] std::vector<double> without_spikes(std::vector<double> values);

}  // namespace enc::models
