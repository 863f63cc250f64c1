// The outline of a fingertip: half a circle and two straight sides that leave it, fitted to the edge of the
// mask. The steps before find many candidates of equal score, most of them behind the cap.
#pragma once

#include "core/base/image.h"
#include "core/vision/stereo/grey.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

struct CapFit {
  bool good = false;
  Pixel centre;  // in the image, of the cap's middle
  // As a camera sees it that looks straight at the centre, core/vision/finger/tangent.h:
  double radius = kUnset;               // px
  double along_x = 0.0, along_y = 0.0;  // unit vector, from the tip to the knuckle
  double misfit = kUnset;               // px rms, of the edge from the outline
};

// The mask counts within so many radii of the start.
inline constexpr double kFarthest = 4.0;

// `start` lies in the finger, at most about `radius` from the circle's middle; `radius` may be wrong by half.
[[nodiscard]] CapFit fit_cap(const Mask& skin, const RectifiedPair& pair, const Pixel& start, double radius);

// The same outline at the sharpest edge of the image near that of the mask, which lacks what the rim of dark
// skin has too little hue for. As it was where that does not succeed.
[[nodiscard]] CapFit sharpen_cap(const Mask& skin, const Grey& image, const RectifiedPair& pair,
                                 const CapFit& fit);

}  // namespace enc
