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
// - A changed pixel too dim for a hue is judged together with its neighbours (Hueless).
//
// It fails in these cases:
// - A hand covers more than half of the frame: its colour then counts as the light's.
// - The light changes in patches with edges, such as a shadow of the hand on a skin-hued surface. Elsewhere
// the surface's hue prevents the error.
// - Background and frame are clipped.
// - Skin has the brightness and colour of its background over more than half of kSurroundings.
// - Any other new thing has the hue of skin.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/kernels/hue.h"
#include "core/vision/segmentation/kernels/kernels.h"
#include "core/vision/segmentation/kernels/majority.h"
#include "core/vision/segmentation/light.h"
#include "core/vision/segmentation/tiles.h"

namespace enc::segmentation {

// The mean of the background's frames, one plane for each channel.
struct Planes {
  std::vector<std::uint8_t> red, green, blue;
};

// Changed pixels too dim for their own hue: each is judged by the sum of similar pixels within 2 px.
//
// A sum of n pixels has sqrt(n) times the noise of one, if their noise is independent. So it has a hue if its
// chroma is sqrt(n) times the HueRule of one pixel: with 25 pixels, a mean chroma a fifth as large. Only
// noise with zero mean averages out; the colour of a sensor's black does not. So the mean brightness keeps
// its own floor, half of the HueRule of one pixel.
//
// A shadow is dim too. So a pixel found here must be more saturated than a bright grey wall in a shadow. If
// the background itself has the hue of skin, no pixel is found: its shadow would look the same.
class HuelessChange {
 public:
  static constexpr int kAround = 2;  // px to each side
  explicit HuelessChange(int width) : columns_(static_cast<std::size_t>(width)) {}

  // Sets `skin` for the `hueless` pixels within `region` that have the hue of skin. `hueless` is valid up to
  // kAround px beyond it. `white` as in FrameLight.
  void find(const ImageView& frame, const Planes& background, const Mask& hueless, const Region& region,
            const std::uint16_t (&white)[3], const Cut& cut, Mask& skin);

 private:
  struct Sum {
    int n = 0;
    std::array<int, 3> rgb{};
  };
  void add_row(const ImageView& frame, const Mask& hueless, int y, int sign, int x0, int x1);
  static bool is_skin(const Sum& sum, const std::uint16_t (&white)[3], const Cut& cut);

  // Column sums of the rows up to kAround px above and below.
  std::vector<Sum> columns_;
};

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
  HuelessChange by_sums_;
  Mask strong_, skin_, hueless_, near_;
};

}  // namespace enc::segmentation
