// Order statistics: what fits, benchmarks and reports share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/frames.h"

namespace enc::models {

// The value below which `share` (0 to 1) of them lie, by nearest rank; NaN where there is none.
template <class T>
[[nodiscard]] double percentile(std::vector<T> values, double share) {
  if (values.empty()) return kUnset;
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return static_cast<double>(values[rank]);
}
template <class T>
[[nodiscard]] double median(const std::vector<T>& values) {
  return percentile(values, 0.5);
}

// Sum of the distances from the median: a size that outliers do not rule.
[[nodiscard]] inline double spread(const std::vector<double>& values) {
  const double middle = median(values);
  double sum = 0.0;
  for (const double x : values) sum += std::abs(x - middle);
  return sum;
}

}  // namespace enc::models
