// How far a fingertip is: the disparity of the middle of its cap. A block of pixels sees the front of a
// sphere, not its middle, and a cap's outline is that of its middle: so the pixels of the cap and of the
// finger next to it are compared with those of the other image as half a sphere and a cylinder would show
// them [Lucas and Kanade]. How the finger slopes is found with it.
#pragma once

#include <span>

#include "core/vision/finger/fingertip.h"
#include "core/vision/stereo/grey.h"

namespace enc {

struct CapDisparity {
  bool good = false;
  double disparity = kUnset;  // px, of the cap's middle
  double variance = kUnset;   // px^2: from what is left over and how much detail there is
  double slope = kUnset;      // rad, from the tip to the knuckle away from the camera
  double left_over = kUnset;  // grey levels^2 of a pixel
};

// `surfaces` are disparities of the finger's front near the cap; some may be wrong.
[[nodiscard]] CapDisparity match_cap(const Grey& left, const Grey& right, const Mask& skin,
                                     const Fingertip& tip, const RectifiedPair& pair,
                                     std::span<const float> surfaces);
// The same were the middle's disparity known to be this one: only the slope is sought.
[[nodiscard]] CapDisparity match_cap_at(const Grey& left, const Grey& right, const Mask& skin,
                                        const Fingertip& tip, const RectifiedPair& pair, double disparity);
// The disparity of the middle of a cap whose front has that one.
[[nodiscard]] double middle_of(double surface, double outline, double focal);
[[nodiscard]] double front_of(double middle, double outline, double focal);

}  // namespace enc
