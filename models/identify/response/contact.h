// The zero of a loop's force and the begin of contact, from readings before and after contact.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "models/identify/response/loop_rows.h"
#include "models/identify/response/onset.h"

namespace enc::models {

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
