// Converts a position in the rectified left image and a disparity to a point in C, with its uncertainty.
#pragma once

#include "core/vision/stereo/rectify.h"

namespace enc {

// A position or a rate in (column, row, disparity), px or px/s. Matching noise is uniform in these
// coordinates.
struct Triplet {
  double column = kUnset, row = kUnset, disparity = kUnset;
  [[nodiscard]] Vec3 e() const { return {column, row, disparity}; }
};

// NaN if the disparity is not positive.
[[nodiscard]] Point<'C'> triangulate(const RectifiedPair& pair, const Triplet& at);
// NaN if the point is not in front of the camera.
[[nodiscard]] Triplet seen_at(const RectifiedPair& pair, const Point<'C'>& point);
// Derivative of the point with respect to (column, row, disparity), m/px. Along the view it is -Z^2 / (f B)
// for the disparity.
[[nodiscard]] Mat3 slope_of(const RectifiedPair& pair, const Triplet& at);

}  // namespace enc
