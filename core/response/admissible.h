// What makes a response fit for an admittance: it grows with deflection, and nowhere more slowly than the
// loop renders.
#pragma once

#include <cmath>
#include <string>

#include "core/error.h"

namespace enc::response {

// The first interval of [0, 1] on which f < 0, in steps fine enough that no dip of note hides between them.
struct Interval {
  double from = 0.0, to = 0.0;
  bool found = false;
};
template <class F>
Interval first_below_zero(const F& f) {
  constexpr int kSteps = 2000;
  Interval bad;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = static_cast<double>(i) / kSteps;
    if (f(u) < 0.0) {
      if (!bad.found) bad.from = u;
      bad.found = true;
      bad.to = u;
    } else if (bad.found) {
      break;
    }
  }
  return bad;
}

// A number to three decimals, without a locale.
inline std::string decimals(double x) {
  const auto thousandths = static_cast<long>(std::lround(x * 1e3));
  const std::string digits = std::to_string(thousandths % 1000);
  return std::to_string(thousandths / 1000) + "." + std::string(3 - digits.size(), '0') + digits;
}

inline void refuse(const Interval& bad, double limit, const std::string& curve, const std::string& key,
                   const std::string& what) {
  if (bad.found)
    throw Error(curve + " curve " + what + " from " + decimals(bad.from * limit * 1e3) + " to " +
                    decimals(bad.to * limit * 1e3) +
                    " (deflection in millimetres); an admittance needs one deflection for each force",
                key);
}
inline std::string too_soft(double lowest_slope) {
  return "is softer than the loop renders stably (" + decimals(lowest_slope * 1e-3) + " N per millimetre)";
}

}  // namespace enc::response
