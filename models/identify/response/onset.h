// The begin of contact on the way to the deepest reading, where the force leaves its zero.
#pragma once

#include <span>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

// Readings from before contact to the deepest one, in order of time.
struct Approach {
  std::vector<double> deflection, force;  // m, N: any zero
};

// Unset if the approaches begin in contact, or shortly before it.
struct Onset {
  double at = kUnset;     // m
  double error = kUnset;  // m, one standard deviation, including the uncertainty of the curve's shape
  [[nodiscard]] bool known() const { return !std::isnan(at) && !std::isnan(error); }
};

// Before contact each approach has its own constant force; after it all share a parabola, in three windows:
// the first 30, 15 and 7 % of the force. The largest window counts if all agree, else the smallest. Their
// spread is a part of the error, because a curve that begins softly is no parabola, and its onset is found
// too late. If each smaller window begins earlier, a quarter of the smallest is added to the error.
[[nodiscard]] Onset find_onset(std::span<const Approach> approaches);

}  // namespace enc::models
