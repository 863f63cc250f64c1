// Grey images for matching.
#pragma once

#include <cstddef>
#include <vector>

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

// A part of a grey image without its finest detail, which is mostly noise.
class SmoothGrey {
 public:
  // Applies that many passes of (1 2 1) / 4 along rows and columns, not rounded: a Gaussian whose variance is
  // half their number, in px^2. Reads `image` as far beyond `part` as there are passes. The result for a
  // pixel does not depend on other requests.
  SmoothGrey(const Grey& image, const Region& part, int passes);

  // Valid arguments of at(): `part` within the image.
  [[nodiscard]] const Region& part() const { return part_; }
  // The right neighbours in the row follow it in memory.
  [[nodiscard]] const float* at(int x, int y) const {
    return level_.data() + static_cast<std::size_t>(y - read_.y0) * stride_ +
           static_cast<std::size_t>(x - read_.x0);
  }

 private:
  void pass();
  Region part_, read_;
  std::size_t stride_ = 0;
  std::vector<float> level_;
};

}  // namespace enc
