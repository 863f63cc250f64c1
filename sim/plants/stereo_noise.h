// A stereo head that sees single points, with the errors of matching: a point in C becomes a place in the
// left image and a disparity, and these a point again [VisHap 2.1; sources/tracking 7]. There are no images
// here: whatever finds the tip in them has done so, with the noise of CameraTruth.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/frames.h"
#include "sim/spec/sensor_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

// Where a point is seen, px: column and row in the left image from its upper left pixel, and by how much the
// right image's column is less.
struct StereoPixel {
  double column = kUnset, row = kUnset, disparity = kUnset;
};

class StereoPoints {
 public:
  StereoPoints(const CameraTruth& truth, std::uint64_t seed);

  // Without errors. Nothing where the point is behind the cameras or outside of either image.
  [[nodiscard]] std::optional<StereoPixel> project(const Point<'C'>& point) const;
  // The point that is seen there; NaN where the disparity is not positive.
  [[nodiscard]] Point<'C'> triangulate(const StereoPixel& pixel) const;
  // How much a point there scatters by noise of one frame, rms along the axes of C, m: to first order.
  [[nodiscard]] Vec<'C'> scatter(const Point<'C'>& point) const;

  // What is seen has moved: draws the errors that stay until it moves again.
  void move();
  // One frame of the point.
  [[nodiscard]] std::optional<Point<'C'>> see(const Point<'C'>& point);

 private:
  CameraTruth truth_;
  Stream frames_, places_;
  Vec3 standing_{0, 0, 0};  // of column, row and disparity, px
};

}  // namespace enc::sim
