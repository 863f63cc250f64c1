// Student's t.
#pragma once

#include <algorithm>

namespace enc::models {

inline constexpr double kNormal95 = 1.959964;  // two-sided quantile of 95 %

// Quantile of Student's t, from that of the normal distribution (Abramowitz and Stegun 26.7.5).
[[nodiscard]] inline double student(double freedom, double z = kNormal95) {
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  const double n = std::max(2.0, freedom);
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

}  // namespace enc::models
