// Disparity of the pixels of a mask. It is matched at the middles of small cells of one grid, so that a
// window gives the same result as the whole frame.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/vision/stereo/match.h"

namespace enc {

class DisparityMap {
 public:
  // px, side; 1 px of the image is 0.8 mm at 600 mm.
  static constexpr int kCell = 4;
  // px: a pixel's value depends on the mask up to this distance, including half of the widest block.
  static constexpr int kReach = 2 * kCell + 8;

  DisparityMap(int width, int height);

  // Matches the cells that touch `wanted` or are next to those, if their middle is in the mask.
  void match(Matcher& matcher, const Grey& left, const Grey& right, const Mask& mask, const Region& wanted);
  // Sets one disparity everywhere.
  void fill(float disparity);
  // Median of the nine cells around the pixel; NaN if no cell has a value.
  [[nodiscard]] float at(int x, int y) const {
    return smooth_[static_cast<std::size_t>(y / kCell) * columns_ + static_cast<std::size_t>(x / kCell)];
  }
  // Cells searched and matched by the last match().
  [[nodiscard]] std::int64_t sought() const { return sought_; }
  [[nodiscard]] std::int64_t found() const { return found_; }

 private:
  [[nodiscard]] float median_round(std::size_t column, std::size_t row) const;

  std::size_t columns_ = 0, rows_ = 0;
  std::vector<float> raw_, smooth_;
  std::int64_t sought_ = 0, found_ = 0;
};

}  // namespace enc
