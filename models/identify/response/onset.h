// The begin of contact on the way to the deepest reading: there the force leaves its zero.
#pragma once

#include <span>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

// From before contact to the deepest reading, in the order of time.
struct Approach {
  std::vector<double> deflection, force;  // m, N: of any zero
};

// Unset if the approaches begin in contact, or shortly before it.
struct Onset {
  double at = kUnset;     // m
  double error = kUnset;  // m, one standard deviation, and what the shape of the curve leaves open
  [[nodiscard]] bool known() const { return !std::isnan(at) && !std::isnan(error); }
};

// Before contact the force of each approach is a constant of its own, after it a parabola of all, in three
// windows: the first 30, 15 and 7 % of the force. The largest counts if all agree, else the smallest. How
// far they lie apart is a part of the error: a curve that begins softly is no parabola, and its onset is
// found too late. Where each smaller window begins earlier, a quarter of the smallest is unsure.
[[nodiscard]] Onset find_onset(std::span<const Approach> approaches);

}  // namespace enc::models
