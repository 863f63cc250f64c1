// Conditions on a response for an admittance: it grows with deflection, and everywhere at least as fast as
// the loop can render.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "core/base/error.h"

namespace enc::response {

// The first interval of [0, 1] with f < 0. The steps are so fine that no relevant dip hides between them.
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

// A number with three decimals, or six digits for large numbers, independent of the locale.
inline std::string decimals(double x) {
  constexpr double kLarge = 1e6;
  std::array<char, 32> text{};
  char* const from = text.data();
  char* const to = from + text.size();
  const auto end = std::abs(x) < kLarge ? std::to_chars(from, to, x, std::chars_format::fixed, 3)
                                        : std::to_chars(from, to, x, std::chars_format::general, 6);
  return {from, end.ptr};
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
