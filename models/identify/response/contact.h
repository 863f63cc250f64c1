// The zero of a loop's force and the begin of contact, from the rows of each press before and after contact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

// The rows of a measured loop, and the rows of each press: approach, press, retreat.
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

// Readings from before contact to the deepest one, in order of time.
struct Approach {
  std::vector<double> deflection, force;  // m, N: any zero
};

// The begin of contact on the way to the deepest reading, where the force leaves its zero. Unset if the
// approaches begin in contact, or shortly before it.
struct Onset {
  double at = kUnset;     // m
  double error = kUnset;  // m, one standard deviation, including the uncertainty of the curve's shape
  [[nodiscard]] bool known() const { return !std::isnan(at) && !std::isnan(error); }
};

// Before contact each approach has its own constant force; after it all share a parabola, in three windows:
// the first 30, 15 and 7 % of the force. The largest window counts if all agree, else the smallest. Their
// spread is a part of the error, because a curve that begins softly is no parabola, and its onset is found
// too late. If each smaller window begins earlier, a quarter of the smallest is added to the error.
[[nodiscard]] Onset find_onset(std::span<const Approach> approaches);

// The zero of a loop's force and the begin of contact, from readings before and after contact.

// Mean force without contact, N, with its standard deviation; unset without such readings.
struct ForceZero {
  double time = kUnset, force = kUnset, error = kUnset;
  // Slope of the line through these readings, N/s, with its standard deviation.
  double rate = kUnset, rate_error = kUnset;
  [[nodiscard]] bool known() const { return !std::isnan(force); }
};

// The zeros around one press. Between them the force's zero is a straight line in time.
struct PressZero {
  ForceZero before, after;
  [[nodiscard]] bool known() const { return before.known() || after.known(); }
  [[nodiscard]] double at(double time) const;  // N; 0 if both are unknown
  [[nodiscard]] double error() const;          // N
};

struct Contact {
  std::vector<PressZero> zeros;  // one for each press
  Onset onset;
  // True if a correction is needed: the value is beyond chance, and more than a thousandth of the force or
  // depth.
  bool subtract = false, shift = false;

  [[nodiscard]] double zero_at(std::size_t press, double time) const {
    return subtract ? zeros[press].at(time) : 0.0;
  }
  [[nodiscard]] double begin() const { return shift ? onset.at : 0.0; }           // m
  [[nodiscard]] double zero_error() const;                                        // N, mean over the presses
  [[nodiscard]] double begin_error() const { return shift ? onset.error : 0.0; }  // m
  // Fastest drift of a zero during a press that bends the curve, N/s.
  double drift = 0.0;
  // The press, counted from 1, after which the force differs and no drift explains it; 0: no such press.
  std::size_t other_press = 0;
  // Excess of that force over the zero before the press, N.
  double other_force = kUnset;
  // The zero moves from press to press, and no reading after contact shows the drift within one.
  bool untold_drift = false;

  // True if an unknown effect bends the curve, so that it is unreliable.
  [[nodiscard]] bool doubted() const { return other_press > 0 || untold_drift; }
  // "before contact the force is 0.60 N: subtracted", "contact begins at 2.00 mm: shifted"
  [[nodiscard]] std::vector<std::string> notes() const;
};

[[nodiscard]] Contact find_contact(std::span<const LoopRow> rows, std::span<const PressRows> presses);

}  // namespace enc::models
