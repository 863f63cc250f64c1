// A second method, ours: a pixel is foreground where neither the background nor a change of light explains
// it.
//
// Better than tiles of hue: each pixel is judged by itself, so that nothing ends at a tile's edge; what is as
// bright and as coloured as the background times the light's gain is background, whatever its hue, so that a
// hand shows before wood by its brightness; limits are the sensor's noise and what the light leaves
// unexplained in this very frame, so that they are narrow while the light is steady; and skin is judged in
// the background's light, so that a lamp of another colour does not move its hue. A pixel of the hue of skin
// that most of its surroundings surely are is skin as well (hysteresis): it fills what looks like the
// background. A changed pixel too dim for a hue is judged with those around it (hueless.h).
//
// It fails where a hand covers more than half of the frame (its colour is then taken for the light's), where
// light changes in patches with edges (a shadow of the hand on a skin-hued surface; elsewhere the hue of the
// surface saves it), where background and frame are clipped, where skin looks like what is behind it in
// brightness and colour over more than half of kSurroundings, and on whatever else of the hue of skin came.
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
  // Of any region, of pixels around it, too.
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
