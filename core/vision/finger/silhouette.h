// Where a fingertip may be in the right image, by its shape alone: the skin round the tip of the left image
// is laid over what has the hue of skin in the right one. It needs no detail within the finger, which is
// like itself where it lies along the rows, and knows nothing where the background has the hue of skin.
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

// What of the right image is looked at.
[[nodiscard]] Region opposite(const Fingertip& tip, const ShiftRange& range, const Region& image);
// The shifts at which the two agree best, up to as many as there is room for; how many. Best first.
std::size_t alike_shapes(const Mask& left, const Mask& right, const Fingertip& tip, const ShiftRange& range,
                         std::span<float> shifts);

}  // namespace enc
