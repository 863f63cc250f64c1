// Skin too dim for a hue of its own: judged together with what like it is around it.
//
// A sum of n pixels has sqrt(n) times the noise of one. So it has a hue where its chroma and its brightest
// channel are sqrt(n) times what HueRule asks of one pixel: that reaches five times deeper into the dark. A
// bright grey wall in a shadow has as much chroma, but no more than a share of its brightness: skin has more.
#pragma once

#include <cstdint>

#include "core/vision/image.h"
#include "core/vision/segmentation/kernels/kernels.h"

namespace enc::segmentation {

inline constexpr int kDimAround = 2;        // px to each side: up to 25 pixels
inline constexpr int kLeastSaturation = 4;  // chroma over the brightest channel: at least one in so many

// Turns `skin` on for those of the pixels `dim` within `region` whose surroundings, up to kDimAround px
// beyond it, have the hue of skin in white light. `white` as in Explained.
void find_dim(const ImageView& frame, const Mask& dim, const Region& region, const std::uint16_t (&white)[3],
              const Cut& cut, Mask& skin);

}  // namespace enc::segmentation
