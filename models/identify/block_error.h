// Errors of an estimate from sums over blocks of time: neighbouring readings have similar errors, blocks
// hardly.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

// A value and half of the width of its 95 % interval. Unset if unknown.
struct Interval {
  double value = kUnset, half = kUnset;
  [[nodiscard]] bool known() const { return !std::isnan(value) && !std::isnan(half); }
  [[nodiscard]] bool holds(double x) const { return x >= value - half && x <= value + half; }
};

inline constexpr double kNormal95 = 1.959964;  // two-sided quantile of 95 %

// Student's t, from the normal quantile (Abramowitz and Stegun 26.7.5).
[[nodiscard]] inline double student(double freedom, double z = kNormal95) {
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  const double n = std::max(2.0, freedom);
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

// Influence of each block of time on one number: the sum of the influences is its error.
struct Blocks {
  std::vector<double> influence, weight;  // weight: information of the block about the number

  [[nodiscard]] double variance() const {
    double sum = 0.0, count = 0.0;
    for (std::size_t b = 0; b < influence.size(); ++b) {
      sum += influence[b] * influence[b];
      count += weight[b] > 0.0 ? 1.0 : 0.0;
    }
    return count > 1.0 ? sum * count / (count - 1.0) : kUnset;
  }
  // Degrees of freedom: the number of equal blocks with as much information, minus one.
  [[nodiscard]] double freedom() const {
    double sum = 0.0, squares = 0.0;
    for (const double w : weight) sum += w, squares += w * w;
    return squares > 0.0 ? sum * sum / squares - 1.0 : 0.0;
  }
  [[nodiscard]] Interval around(double value) const {
    return {value, student(freedom()) * std::sqrt(variance())};
  }
};

}  // namespace enc::models
