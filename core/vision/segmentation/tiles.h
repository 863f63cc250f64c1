// The published method [VisHap 2.1.1]: a tile is foreground if its histogram of hue has too little in common
// with that of the background's mean; within a foreground tile, the pixels with the hue of skin stay.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/grid.h"
#include "core/vision/segmentation/kernels/kernels.h"

namespace enc::segmentation {

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
