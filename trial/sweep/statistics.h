// Statistics of a sweep's figures: summary, and the effect of each parameter on each figure.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/frames.h"

namespace enc::trial {

// Of the values that are numbers. Unset where there are too few: 2 for `sd`, 3 for `half`, and
// models::has_percentile() for the percentiles.
struct Summary {
  std::size_t n = 0;
  double mean = kUnset, sd = kUnset;
  double half = kUnset;  // half the 95 % interval of the mean (Student's t)
  double least = kUnset, p5 = kUnset, median = kUnset, p95 = kUnset, most = kUnset;
};
[[nodiscard]] Summary summary_of(const std::vector<double>& values);

// Runs of one value of a parameter, or of a part of its range.
struct EffectLevel {
  std::string name;
  double x = kUnset;  // mean of the parameter; unset: words
  Summary summary;
};
struct Effect {
  std::vector<EffectLevel> levels;
  double share = kUnset;  // of the figure's variance, between the levels
};
// `parameter` and `values` by run. Up to `most` different values make a level each; more make so many levels
// with equally many runs.
[[nodiscard]] Effect effect_of(const std::vector<std::string>& parameter, const std::vector<double>& values,
                               std::size_t most = 12);

// The number, if the whole text is one; else unset.
[[nodiscard]] double number_of(const std::string& text);

}  // namespace enc::trial
