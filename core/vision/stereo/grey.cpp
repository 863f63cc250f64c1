#include "core/vision/stereo/grey.h"

namespace enc {

void to_grey(const ImageView& image, const Region& part, Grey& grey) {
  const Region cut = part.cut({0, 0, grey.width, grey.height}).cut({0, 0, image.width, image.height});
  for (int y = cut.y0; y < cut.y1; ++y) {
    const std::uint8_t* from = image.at(cut.x0, y);
    std::uint8_t* to = grey.at(cut.x0, y);
    const int count = cut.width();
    for (int x = 0; x < count; ++x)
      to[x] = static_cast<std::uint8_t>(
          (77U * from[3 * x] + 150U * from[3 * x + 1] + 29U * from[3 * x + 2] + 128U) >> 8U);
  }
}

}  // namespace enc
