// The core's model of a stereo head: rig table [camera], or a file written by `encounter calibrate stereo`.
#pragma once

#include <array>
#include <string>

#include "core/base/frames.h"
#include "core/base/image.h"

namespace enc {

// A pinhole with radial and tangential distortion, in OpenCV's order: k1, k2, p1, p2, k3.
struct Lens {
  double focal_x = 721.0, focal_y = 721.0;    // px
  double centre_x = 319.5, centre_y = 239.5;  // px
  std::array<double, 5> distortion{0, 0, 0, 0, 0};
};
// Square pixels, the axis through the middle of the image, no distortion. `focal` in px.
[[nodiscard]] inline Lens pinhole(std::int64_t width, std::int64_t height, double focal) {
  return {focal, focal, 0.5 * static_cast<double>(width - 1), 0.5 * static_cast<double>(height - 1)};
}

// Left camera C: x along the image's rows, y down its columns, z into the scene. STH-MDCS with 7.5 mm lenses,
// 1280 x 960 binned to 640 x 480 (sources/tracking 7).
struct StereoRig {
  std::string driver = "none";
  std::string calibration;                 // file with the other keys; empty: the numbers here
  std::int64_t width = 640, height = 480;  // px, each image
  double rate = 20.0;                      // Hz, frames
  double latency = 0.050;                  // s, from exposure to the fingertip
  Lens left, right;
  Pose<'C', 'D'> X_CD = Pose<'C', 'D'>::shift(0.090, 0, 0);  // right camera in C

  [[nodiscard]] ImageSize size() const { return {static_cast<int>(width), static_cast<int>(height)}; }
};

}  // namespace enc
