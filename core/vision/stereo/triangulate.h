// From a place in the rectified left image and a disparity to a point in C, and what is known of it.
#pragma once

#include "core/vision/stereo/rectify.h"

namespace enc {

// A place, or a rate, in (column, row, disparity), px or px/s. Noise of matching is the same everywhere in
// it.
struct Triplet {
  double column = kUnset, row = kUnset, disparity = kUnset;
  [[nodiscard]] Vec3 e() const { return {column, row, disparity}; }
};

// NaN where the disparity is not positive.
[[nodiscard]] Point<'C'> triangulate(const RectifiedPair& pair, const Triplet& at);
// NaN where the point is not in front.
[[nodiscard]] Triplet seen_at(const RectifiedPair& pair, const Point<'C'>& point);
// What a small change of (column, row, disparity) there does to the point, m/px. Along the view it is
// -Z^2 / (f B) of the disparity's.
[[nodiscard]] Mat3 slope_of(const RectifiedPair& pair, const Triplet& at);

}  // namespace enc
