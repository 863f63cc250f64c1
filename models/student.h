// Student's t.
#pragma once

#include <algorithm>
#include <cmath>

namespace enc::models {

inline constexpr double kNormal95 = 1.959964;  // two-sided quantile of 95 %

// Quantile of Student's t, from that of the normal distribution (Abramowitz and Stegun 26.7.5). Below three
// degrees of freedom, where that series is up to a third too small, between the exact values at one and two.
[[nodiscard]] inline double student(double freedom, double z = kNormal95) {
  const auto series = [z](double n) {
    const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z, z9 = z7 * z * z;
    return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
           (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n) +
           (79 * z9 + 776 * z7 + 1482 * z5 - 1920 * z3 - 945 * z) / (92160 * n * n * n * n);
  };
  if (freedom >= 3.0) return series(freedom);
  const double share = std::erf(z / M_SQRT2);  // of the distribution, between both quantiles
  const double at1 = std::tan(M_PI_2 * share), at2 = share * std::sqrt(2.0 / (1.0 - share * share));
  const double n = std::max(1.0, freedom), from = n < 2.0 ? 1.0 : 2.0;
  const double low = n < 2.0 ? at1 : at2, high = n < 2.0 ? at2 : series(3.0);
  return low * std::pow(high / low, (1.0 / from - 1.0 / n) / (1.0 / from - 1.0 / (from + 1.0)));
}

}  // namespace enc::models
