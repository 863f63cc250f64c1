// The background from its first frames: mean in RGB [VisHap 3], and its variation.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/grid.h"

namespace enc::segmentation {

class Background {
 public:
  explicit Background(const Grid& grid);
  void add(const ImageView& frame);
  [[nodiscard]] int frames() const { return frames_; }
  [[nodiscard]] Image mean() const;  // rounded to the nearest
  // Standard deviation of a channel in each tile, out of 255, row by row. The minimum is kLeastNoise, which
  // rounding and a lamp's flicker leave even in a sensor without noise.
  [[nodiscard]] std::vector<double> noise() const;

  static constexpr double kLeastNoise = 0.7;

 private:
  Grid grid_;
  int frames_ = 0;
  std::vector<std::uint16_t> sum_;
  std::vector<std::uint32_t> squares_;
};

// Share of the tiles that vary more than four times as much as the median tile: something moved there while
// the background was learned.
[[nodiscard]] double unrest(std::vector<double> noise);

}  // namespace enc::segmentation
