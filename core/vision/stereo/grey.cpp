#include "core/vision/stereo/grey.h"

#include <algorithm>

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

SmoothGrey::SmoothGrey(const Grey& image, const Region& part, int passes)
    : part_(part.cut({0, 0, image.width, image.height})),
      read_(Region{part.x0 - passes, part.y0 - passes, part.x1 + passes, part.y1 + passes}.cut(
          {0, 0, image.width, image.height})) {
  if (part_.empty()) return;
  stride_ = static_cast<std::size_t>(read_.width());
  level_.resize(stride_ * static_cast<std::size_t>(read_.y1 - read_.y0));
  for (int y = read_.y0; y < read_.y1; ++y)
    std::copy_n(
        image.at(read_.x0, y), stride_,
        level_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y - read_.y0) * stride_));
  for (int i = 0; i < passes; ++i) pass();
}

// Works in place; at the border the pixel itself replaces the missing neighbour.
void SmoothGrey::pass() {
  const std::size_t rows = level_.size() / stride_;
  for (std::size_t y = 0; y < rows; ++y) {
    float* row = level_.data() + y * stride_;
    float before = row[0];
    for (std::size_t x = 0; x < stride_; ++x) {
      const float own = row[x], after = x + 1 < stride_ ? row[x + 1] : own;
      row[x] = 0.25F * (before + 2.0F * own + after);
      before = own;
    }
  }
  std::vector<float> above(level_.begin(), level_.begin() + static_cast<std::ptrdiff_t>(stride_));
  for (std::size_t y = 0; y < rows; ++y) {
    float* row = level_.data() + y * stride_;
    const float* below = y + 1 < rows ? row + stride_ : row;
    for (std::size_t x = 0; x < stride_; ++x) {
      const float own = row[x];
      row[x] = 0.25F * (above[x] + 2.0F * own + below[x]);
      above[x] = own;
    }
  }
}

}  // namespace enc
