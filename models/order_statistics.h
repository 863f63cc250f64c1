// Order statistics for fits, benchmarks and reports.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

// The value below which `share` (0 to 1) of the values lie, by nearest rank; NaN without values.
template <class T>
[[nodiscard]] double percentile(std::vector<T> values, double share) {
  if (values.empty()) return kUnset;
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return static_cast<double>(values[rank]);
}
// True if that many values determine such a percentile: at least ten, and on average at least one of them
// lies beyond it. p50 needs 10 values, p95 and p5 need 20, p99 needs 100, p99.9 needs 1000. Minimum and
// maximum need one.
[[nodiscard]] constexpr bool has_percentile(std::size_t count, double share) {
  constexpr std::size_t kFewest = 10;
  const double beyond = share < 0.5 ? share : 1.0 - share;
  if (beyond <= 0.0) return count > 0;
  return count >= kFewest && beyond * static_cast<double>(count) >= 1.0 - 1e-9;
}
// As percentile(); NaN if there are too few values for it.
template <class T>
[[nodiscard]] double known_percentile(const std::vector<T>& values, double share) {
  return has_percentile(values.size(), share) ? percentile(values, share) : kUnset;
}
template <class T>
[[nodiscard]] double median(const std::vector<T>& values) {
  return percentile(values, 0.5);
}

// Sum of the distances from the median: a measure that outliers do not dominate.
[[nodiscard]] inline double spread(const std::vector<double>& values) {
  const double middle = median(values);
  double sum = 0.0;
  for (const double x : values) sum += std::abs(x - middle);
  return sum;
}

}  // namespace enc::models
