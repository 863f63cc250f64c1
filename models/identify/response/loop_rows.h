// The rows of a measured loop, and which of them belong to one press: the way in, the press, the way out.
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
  double force = kUnset;    // N, as in the file; unset: the file has none, which only a row outside may lack
  std::int64_t repeat = 0;  // 0: outside of a press
  // The row stands in this line of the file.
  std::size_t line = 0;
};

// Indices of rows, all included. The approach is `from` to `deepest`, the retreat `deepest` to `to`. Rows
// between two presses may belong to the retreat of the first and to the approach of the second.
struct PressRows {
  std::size_t first = 0, last = 0;  // marked as this press
  std::size_t deepest = 0;
  std::size_t from = 0, to = 0;
};

// In the order of time. A press is what carries one number of `repeat`; where the force falls to nothing and
// rises again under one number, these are two presses.
[[nodiscard]] std::vector<PressRows> presses_in(std::span<const LoopRow> rows);

// Standard deviation of a position, m, from second differences: a steady motion has none.
[[nodiscard]] double position_noise(std::span<const double> positions);

// Each value, or the middle one of it and its neighbours where it lies outside of them: single spikes go.
[[nodiscard]] std::vector<double> without_spikes(std::vector<double> values);

}  // namespace enc::models
