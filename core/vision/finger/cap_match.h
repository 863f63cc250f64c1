// Distance of a fingertip: the disparity of the middle of its cap. A block of pixels measures the front of a
// sphere, not its middle, while a cap's outline belongs to its middle. So the fit models the cap as half a
// sphere and the adjacent finger as a cylinder. It compares their pixels with the other image [Lucas and
// Kanade]. The fit also gives the finger's slope.
#pragma once

#include <span>

#include "core/vision/finger/fingertip.h"
#include "core/vision/stereo/grey.h"

namespace enc {

struct CapDisparity {
  bool good = false;
  double disparity = kUnset;  // px, at the cap's middle
  double variance = kUnset;   // px^2: from the residual and the amount of detail
  // rad, away from the camera, from the tip to the knuckle.
  double slope = kUnset;
  double left_over = kUnset;  // grey levels^2 of a pixel, residual
};

// `surfaces` are disparities of the finger's front near the cap; some may be wrong.
[[nodiscard]] CapDisparity match_cap(const Grey& left, const Grey& right, const Mask& skin,
                                     const Fingertip& tip, const RectifiedPair& pair,
                                     std::span<const float> surfaces);
// As match_cap(), with a known disparity of the middle: only the slope is fitted.
[[nodiscard]] CapDisparity match_cap_at(const Grey& left, const Grey& right, const Mask& skin,
                                        const Fingertip& tip, const RectifiedPair& pair, double disparity);
// Disparity of the middle of a cap from that of its front, and the inverse.
[[nodiscard]] double middle_of(double surface, double outline, double focal);
[[nodiscard]] double front_of(double middle, double outline, double focal);

}  // namespace enc
