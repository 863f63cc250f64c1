// A number with its uncertainty.
#pragma once

#include <cmath>

#include "core/base/frames.h"
#include "models/identify/block_error.h"

namespace enc::models {

inline constexpr double kNormal99 = 2.575829;  // two-sided quantile of 99 %

// Half of the width of the 99 % interval. A wrong calibration moves a machine to a wrong position, so its
// intervals are wider than those of a report.
struct Uncertain {
  double value = kUnset, half = kUnset;
  [[nodiscard]] bool holds(double x) const { return std::abs(x - value) <= half; }
};
struct UncertainVec {
  Vec3 value{kUnset, kUnset, kUnset}, half{kUnset, kUnset, kUnset};
  [[nodiscard]] bool holds(const Vec3& x) const { return ((x - value).array().abs() <= half.array()).all(); }
};

}  // namespace enc::models
