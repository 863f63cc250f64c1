// Changed pixels too dim for their own hue: each is judged by the sum of similar pixels within 2 px.
//
// A sum of n pixels has sqrt(n) times the noise of one, if their noise is independent. So it has a hue if its
// chroma is sqrt(n) times the HueRule of one pixel: with 25 pixels, a mean chroma a fifth as large. Only
// noise with zero mean averages out; the colour of a sensor's black does not. So the mean brightness keeps
// its own floor, half of the HueRule of one pixel.
//
// A shadow is dim too. So a pixel found here must be more saturated than a bright grey wall in a shadow. If
// the background itself has the hue of skin, no pixel is found: its shadow would look the same.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/kernels/kernels.h"

namespace enc::segmentation {

// The mean of the background's frames, one plane for each channel.
struct Planes {
  std::vector<std::uint8_t> red, green, blue;
};

class Hueless {
 public:
  static constexpr int kAround = 2;  // px to each side
  explicit Hueless(int width) : columns_(static_cast<std::size_t>(width)) {}

  // Sets `skin` for the `hueless` pixels within `region` that have the hue of skin. `hueless` is valid up to
  // kAround px beyond it. `white` as in Explained.
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

}  // namespace enc::segmentation
