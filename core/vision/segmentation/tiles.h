// The tiles of an image, the background from its first frames, and the published method.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/kernels/kernels.h"

namespace enc::segmentation {

// The one grid of tiles of an image, from its upper left; the last column and row may be narrower.
struct Grid {
  int width = 0, height = 0, tile = 1;  // px

  [[nodiscard]] int columns() const { return (width + tile - 1) / tile; }
  [[nodiscard]] int rows() const { return (height + tile - 1) / tile; }
  [[nodiscard]] Region whole() const { return {0, 0, width, height}; }
  [[nodiscard]] Region tile_at(int column, int row) const {
    return Region{column * tile, row * tile, (column + 1) * tile, (row + 1) * tile}.cut(whole());
  }
  // The tiles that touch `wanted`, widened by `margin` px on each side.
  [[nodiscard]] Region touched(const Region& wanted, int margin = 0) const {
    Region r = wanted.cut(whole());
    if (r.empty()) return {};
    r = Region{r.x0 - margin, r.y0 - margin, r.x1 + margin, r.y1 + margin}.cut(whole());
    const auto up = [this](int x) { return (x + tile - 1) / tile * tile; };
    return Region{r.x0 / tile * tile, r.y0 / tile * tile, up(r.x1), up(r.y1)}.cut(whole());
  }
};

// The background from its first frames: mean in RGB [VisHap 3], and its variation.
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

// The published method [VisHap 2.1.1]: a tile is foreground if its histogram of hue has too little in common
// with that of the background's mean; within a foreground tile, the pixels with the hue of skin stay.
class Tiles {
 public:
  Tiles(const Kernels& kernels, const Grid& grid, int bins);
  void learn(const Image& mean, const Cut& cut);
  // Foreground if H(I, M) = sum min(I, M) / sum M [VisHap eq. 1] is below `match`. Pixels without a hue form
  // one more bin of both, which is our addition. So H is defined for a grey tile, and a grey tile matches a
  // grey one; a hand in front of a white wall does not. sum M is then the tile's number of pixels. `region`
  // must consist of whole tiles.
  void candidates(const ImageView& frame, const Region& region, double match, const Cut& cut, Mask& out);

 private:
  void histograms(const Region& tiles);  // one row of tiles, from columns_ into seen_
  void match_tiles(const Region& tiles, double match);
  void widen(int width);

  const Kernels& kernels_;
  Grid grid_;
  int bins_;
  std::vector<std::uint64_t> model_, seen_;  // one byte for each bin
  std::vector<std::uint32_t> columns_;       // four bits for each bin
  std::vector<std::uint8_t> found_, wide_;   // one byte for each tile; for each pixel
};

// Number of a tile's pixels that must be in common.
[[nodiscard]] int needed(double match, int pixels);

}  // namespace enc::segmentation
