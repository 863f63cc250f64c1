// The median of a few measurements, in place.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "core/base/frames.h"

namespace enc {

// The upper median for an even number; NaN for an empty span. Reorders the values.
[[nodiscard]] inline double upper_median(std::span<double> values) {
  if (values.empty()) return kUnset;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace enc
