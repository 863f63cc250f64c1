// Possible positions of a fingertip in the right image, by its shape alone: the skin around the tip of the
// left image is shifted over the pixels with the hue of skin in the right one. This needs no detail within
// the finger, which looks the same along its length if it lies along the rows. It fails if the background has
// the hue of skin.
#pragma once

#include <cstddef>
#include <span>

#include "core/base/image.h"
#include "core/vision/finger/fingertip.h"

namespace enc {

// Disparities of the cap's middle, px.
struct ShiftRange {
  int least = 0, most = 0;
};

// Region of the right image that is compared.
[[nodiscard]] Region opposite(const Fingertip& tip, const ShiftRange& range, const Region& image);
// Writes the best-fitting shifts, best first, at most as many as `shifts` holds; returns their number.
std::size_t alike_shapes(const Mask& left, const Mask& right, const Fingertip& tip, const ShiftRange& range,
                         std::span<float> shifts);

}  // namespace enc
