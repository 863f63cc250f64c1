// A stereo head that measures single points, with the errors of matching: a point in C becomes a position in
// the left image and a disparity, and these become a point again [VisHap 2.1; sources/tracking 7]. It uses no
// images: the tip counts as found, with the noise of CameraTruth.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/frames.h"
#include "sim/spec/sensor_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

// Image of a point, px: column and row in the left image from its upper left pixel, and the disparity, left
// column minus right column.
struct StereoPixel {
  double column = kUnset, row = kUnset, disparity = kUnset;
};

class StereoPoints {
 public:
  StereoPoints(const CameraTruth& truth, std::uint64_t seed);

  // Projection without errors. Empty if the point is behind the cameras or outside of either image.
  [[nodiscard]] std::optional<StereoPixel> project(const Point<'C'>& point) const;
  // The point with that image; NaN if the disparity is not positive.
  [[nodiscard]] Point<'C'> triangulate(const StereoPixel& pixel) const;
  // Scatter of a point by the noise of one frame, rms along the axes of C, m: to first order.
  [[nodiscard]] Vec<'C'> scatter(const Point<'C'>& point) const;

  // Call this when the object has moved: draws the errors that stay until it moves again.
  void move();
  // One frame of the point.
  [[nodiscard]] std::optional<Point<'C'>> see(const Point<'C'>& point);

 private:
  CameraTruth truth_;
  Stream frames_, places_;
  Vec3 standing_{0, 0, 0};  // column, row and disparity, px
};

}  // namespace enc::sim
