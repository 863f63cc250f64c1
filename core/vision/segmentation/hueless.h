// Changed pixels too dim for a hue of their own: judged by the sum of those within 2 px that are like them.
//
// A sum of n pixels has sqrt(n) times the noise of one, where their noise is independent. So it has a hue
// where its chroma is sqrt(n) times what HueRule asks of one pixel: with 25 of them a mean chroma a fifth as
// large. Noise without a mean is what averages out: the colour of a sensor's black does not, so that the mean
// brightness keeps a floor of its own, half of what HueRule asks of one pixel.
//
// A shadow is dim, too. So what is found is more saturated than a bright grey wall in a shadow, and where the
// background itself has the hue of skin, nothing is found: its shadow would look the same.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/kernels/kernels.h"

namespace enc::segmentation {

// The mean of the background's frames, a plane for each channel.
struct Planes {
  std::vector<std::uint8_t> red, green, blue;
};

class Hueless {
 public:
  static constexpr int kAround = 2;  // px to each side
  explicit Hueless(int width) : columns_(static_cast<std::size_t>(width)) {}

  // Turns `skin` on for those of the pixels `hueless` within `region` that have the hue of skin. `hueless` is
  // valid up to kAround px beyond it. `white` as in Explained.
  void find(const ImageView& frame, const Planes& background, const Mask& hueless, const Region& region,
            const std::uint16_t (&white)[3], const Cut& cut, Mask& skin);

 private:
  struct Sum {
    int n = 0;
    std::array<int, 3> rgb{};
  };
  void add_row(const ImageView& frame, const Mask& hueless, int y, int sign, int x0, int x1);
  static bool is_skin(const Sum& sum, const std::uint16_t (&white)[3], const Cut& cut);

  std::vector<Sum> columns_;  // of the rows up to kAround px above and below
};

}  // namespace enc::segmentation
