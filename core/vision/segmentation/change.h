// A second method, ours: a pixel is foreground if neither the background nor a change of light explains it.
//
// Advantages over tiles of hue:
// - Each pixel is judged by itself, so no result ends at a tile's edge.
// - A pixel as bright and as coloured as the background times the light's gain is background, whatever its
// hue. A hand in front of wood shows by its brightness.
// - The limits are the sensor's noise and the light's residual in this very frame, so they are narrow while
// the light is steady.
// - Skin is judged in the background's light, so a lamp of another colour does not shift its hue.
// - A pixel with the hue of skin is also skin if most of its surroundings surely are (hysteresis). This fills
// areas that look like the background.
// - A changed pixel too dim for a hue is judged together with its neighbours (hueless.h).
//
// It fails in these cases:
// - A hand covers more than half of the frame: its colour then counts as the light's.
// - The light changes in patches with edges, such as a shadow of the hand on a skin-hued surface. Elsewhere
// the surface's hue prevents the error.
// - Background and frame are clipped.
// - Skin has the brightness and colour of its background over more than half of kSurroundings.
// - Any other new thing has the hue of skin.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/grid.h"
#include "core/vision/segmentation/hueless.h"
#include "core/vision/segmentation/kernels/arc.h"
#include "core/vision/segmentation/kernels/kernels.h"
#include "core/vision/segmentation/kernels/majority.h"
#include "core/vision/segmentation/light.h"

namespace enc::segmentation {

class Change {
 public:
  static constexpr int kSurroundings = 9;  // px
  Change(const Kernels& kernels, const Grid& grid, const Image& mean, const std::vector<double>& noise);
  // Works on any region; also reads the pixels around it.
  void candidates(const ImageView& frame, const Region& region, double change, const Cut& cut, Mask& out);

 private:
  void row_of(const Light& light, int y, const Region& region);

  const Kernels& kernels_;
  Grid grid_;
  Planes background_;
  std::vector<std::uint8_t> noise_;
  std::vector<std::uint16_t> side_;
  LightMeter meter_;
  Majority surroundings_;
  Hueless by_sums_;
  Mask strong_, skin_, hueless_, near_;
};

}  // namespace enc::segmentation
