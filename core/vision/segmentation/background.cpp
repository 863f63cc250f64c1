#include "core/vision/segmentation/background.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace enc::segmentation {

Background::Background(const Grid& grid)
    : grid_(grid),
      sum_(3 * static_cast<std::size_t>(grid.whole().pixels())),
      squares_(3 * static_cast<std::size_t>(grid.whole().pixels())) {}

void Background::add(const ImageView& frame) {
  ++frames_;
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const std::uint32_t value = frame.rgb[i];
    sum_[i] = static_cast<std::uint16_t>(sum_[i] + value);
    squares_[i] += value * value;
  }
}

Image Background::mean() const {
  Image image(grid_.width, grid_.height);
  for (std::size_t i = 0; i < sum_.size(); ++i)
    image.rgb[i] = static_cast<std::uint8_t>((sum_[i] + frames_ / 2) / frames_);
  return image;
}

std::vector<double> Background::noise() const {
  std::vector<double> noise;
  const auto n = static_cast<std::int64_t>(frames_);
  for (int row = 0; row < grid_.rows(); ++row)
    for (int column = 0; column < grid_.columns(); ++column) {
      const Region tile = grid_.tile_at(column, row);
      std::int64_t varied = 0;  // n times the sum of squares about the means
      for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = 3 * tile.x0; x < 3 * tile.x1; ++x) {
          const auto i = 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.width) +
                         static_cast<std::size_t>(x);
          varied += n * squares_[i] - std::int64_t{sum_[i]} * sum_[i];
        }
      const double free = 3.0 * static_cast<double>(tile.pixels() * n * std::max<std::int64_t>(1, n - 1));
      noise.push_back(std::max(kLeastNoise, std::sqrt(static_cast<double>(varied) / free)));
    }
  return noise;
}

double unrest(std::vector<double> noise) {
  if (noise.empty()) return 0.0;
  const auto middle = noise.begin() + static_cast<std::ptrdiff_t>(noise.size() / 2);
  std::nth_element(noise.begin(), middle, noise.end());
  const double usual = *middle;
  const auto moved = std::count_if(noise.begin(), noise.end(), [&](double s) { return s > 4.0 * usual; });
  return static_cast<double>(moved) / static_cast<double>(noise.size());
}

}  // namespace enc::segmentation
