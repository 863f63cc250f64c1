#include "core/vision/stereo/triangulate.h"

namespace enc {

Point<'C'> triangulate(const RectifiedPair& pair, const Triplet& at) {
  if (!(at.disparity > 0.0)) return {};
  const double each = pair.baseline / at.disparity;  // m that a pixel is wide there
  return Point<'C'>(
      Vec3(pair.turn * (each * Vec3(at.column - pair.centre_x, at.row - pair.centre_y, pair.focal))));
}

Triplet seen_at(const RectifiedPair& pair, const Point<'C'>& point) {
  const Vec3 p = pair.turn.transpose() * point.e();
  if (!(p.z() > 0.0)) return {};
  const double scale = pair.focal / p.z();
  return {pair.centre_x + scale * p.x(), pair.centre_y + scale * p.y(), scale * pair.baseline};
}

Mat3 slope_of(const RectifiedPair& pair, const Triplet& at) {
  if (!(at.disparity > 0.0)) return Mat3::Constant(kUnset);
  const double each = pair.baseline / at.disparity;
  Mat3 slope;
  slope << each, 0.0, -each * (at.column - pair.centre_x) / at.disparity,  //
      0.0, each, -each * (at.row - pair.centre_y) / at.disparity,          //
      0.0, 0.0, -each * pair.focal / at.disparity;
  return pair.turn * slope;
}

}  // namespace enc
