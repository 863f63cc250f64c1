// Grey images for matching.
#pragma once

#include "core/base/image.h"

namespace enc {

// Rows from the top. Kernels may read the room behind each row and behind the last.
struct Grey {
  static constexpr int kRoom = 64;
  int width = 0, height = 0;
  std::size_t stride = 0;
  std::vector<std::uint8_t> level;

  Grey() = default;
  Grey(int w, int h)
      : width(w),
        height(h),
        stride(static_cast<std::size_t>(w) + kRoom),
        level(stride * static_cast<std::size_t>(h) + kRoom) {}
  [[nodiscard]] const std::uint8_t* at(int x, int y) const {
    return level.data() + stride * static_cast<std::size_t>(y) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::uint8_t* at(int x, int y) {
    return level.data() + stride * static_cast<std::size_t>(y) + static_cast<std::size_t>(x);
  }
};

// 0.299 R + 0.587 G + 0.114 B in 1/256, within `part` of the image.
void to_grey(const ImageView& image, const Region& part, Grey& grey);

}  // namespace enc
