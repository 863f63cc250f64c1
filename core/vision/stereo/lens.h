// A lens: from a ray to its pixel, and back. OpenCV's convention: k1, k2, p1, p2, k3 [calib3d, "Detailed
// Description"].
#pragma once

#include "core/spec/vision/stereo_rig.h"

namespace enc {

struct Pixel {
  double column = kUnset, row = kUnset;  // px
};

// A ray from the camera's centre, given by its intersection with the plane z = 1 of the camera's frame.
struct Ray {
  double x = kUnset, y = kUnset;
};

[[nodiscard]] Pixel project(const Lens& lens, const Ray& ray);
// NaN if no ray meets that pixel: far outside of the image, a strong distortion folds back.
[[nodiscard]] Ray ray_of(const Lens& lens, const Pixel& pixel);

}  // namespace enc
