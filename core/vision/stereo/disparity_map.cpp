#include "core/vision/stereo/disparity_map.h"

#include <algorithm>
#include <array>
#include <limits>

namespace enc {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

std::size_t cells(int pixels) {
  return static_cast<std::size_t>((pixels + DisparityMap::kCell - 1) / DisparityMap::kCell);
}

}  // namespace

DisparityMap::DisparityMap(int width, int height)
    : columns_(cells(width)),
      rows_(cells(height)),
      raw_(columns_ * rows_, kNone),
      smooth_(columns_ * rows_, kNone) {}

void DisparityMap::fill(float disparity) {
  std::fill(raw_.begin(), raw_.end(), disparity);
  std::fill(smooth_.begin(), smooth_.end(), disparity);
}

void DisparityMap::match(Matcher& matcher, const Grey& left, const Grey& right, const Mask& mask,
                         const Region& wanted) {
  const int last_column = static_cast<int>(columns_) - 1, last_row = static_cast<int>(rows_) - 1;
  const Region inner{wanted.x0 / kCell, wanted.y0 / kCell, (wanted.x1 - 1) / kCell, (wanted.y1 - 1) / kCell};
  sought_ = found_ = 0;
  if (wanted.empty()) return;
  for (int row = std::max(0, inner.y0 - 1); row <= std::min(last_row, inner.y1 + 1); ++row)
    for (int column = std::max(0, inner.x0 - 1); column <= std::min(last_column, inner.x1 + 1); ++column) {
      const int x = column * kCell + kCell / 2, y = row * kCell + kCell / 2;
      float& value = raw_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)];
      value = kNone;
      if (x >= mask.width || y >= mask.height || !mask.at(x, y)) continue;
      value = matcher.at(left, right, x, y, &mask).pixels;
      ++sought_;
      found_ += std::isfinite(value) ? 1 : 0;
    }
  for (int row = inner.y0; row <= inner.y1; ++row)
    for (int column = inner.x0; column <= inner.x1; ++column) {
      const auto c = static_cast<std::size_t>(column), r = static_cast<std::size_t>(row);
      smooth_[r * columns_ + c] = median_round(c, r);
    }
}

// The lower of the two in the middle, so that it is a value that was found.
float DisparityMap::median_round(std::size_t column, std::size_t row) const {
  std::array<float, 9> values{};
  std::size_t count = 0;
  for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(rows_ - 1, row + 1); ++r)
    for (std::size_t c = column == 0 ? 0 : column - 1; c <= std::min(columns_ - 1, column + 1); ++c) {
      const float value = raw_[r * columns_ + c];
      if (!std::isfinite(value)) continue;
      std::size_t i = count++;
      for (; i > 0 && values[i - 1] > value; --i) values[i] = values[i - 1];
      values[i] = value;
    }
  return count == 0 ? kNone : values[(count - 1) / 2];
}

}  // namespace enc
