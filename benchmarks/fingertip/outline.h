// How large the finger's cap was drawn: the outline of its sphere in the left image, an ellipse, measured in
// the true mask of skin.
#pragma once

#include "benchmarks/staged/staged.h"
#include "core/vision/stereo/rectify.h"

namespace enc::bench::fingertip {

struct Outline {
  // px, the ellipse's smaller half axis. It lies across the direction from the image's middle, and is
  // f R / sqrt(z2 - R2) wherever the cap is: the r = K / z of [VisHap]. None where the rim is hidden.
  double across = kUnset;
  double area =
      kUnset;  // px, radius of the circle of the ellipse's area: larger, the farther from the middle
};
[[nodiscard]] Outline outline(const RectifiedPair& pair, const staged::Shot& shot,
                              const sim::PixelTruth& truth);

}  // namespace enc::bench::fingertip
