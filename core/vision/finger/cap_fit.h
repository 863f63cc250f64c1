// The outline of a fingertip: a semicircle and the two straight sides that leave it, fitted to the edge of
// the mask. The steps before find many candidates of equal score, most of them behind the cap.
#pragma once

#include "core/base/image.h"
#include "core/vision/stereo/grey.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

struct CapFit {
  bool good = false;
  Pixel centre;  // middle of the cap, in the image
  // Seen by a virtual camera that looks straight at the centre, core/vision/finger/tangent.h:
  double radius = kUnset;               // px
  double along_x = 0.0, along_y = 0.0;  // unit vector, from the tip to the knuckle
  double misfit = kUnset;               // px rms, edge against outline
};

// Radii around the start within which the mask counts.
inline constexpr double kFarthest = 4.0;

// `start` lies in the finger, at most about `radius` from the circle's middle; `radius` may be wrong by half.
[[nodiscard]] CapFit fit_cap(const Mask& skin, const RectifiedPair& pair, const Pixel& start, double radius);

// Refits the outline to the sharpest image edge near the mask's edge. The mask lacks the rim of dark skin,
// which has too little hue. Returns `fit` if the refit fails.
[[nodiscard]] CapFit sharpen_cap(const Mask& skin, const Grey& image, const RectifiedPair& pair,
                                 const CapFit& fit);

}  // namespace enc
