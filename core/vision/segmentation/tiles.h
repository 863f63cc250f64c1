// The published method [VisHap 2.1.1]: a tile whose histogram of hue has too little in common with that of
// the background's mean is foreground; of a foreground tile those pixels stay that are of the hue of skin.
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
  // H(I, M) = sum min(I, M) / sum M [VisHap eq. 1] below `match` is foreground. Pixels without a hue are one
  // more bin of both, which is ours: so H is defined for a grey tile, a grey tile is like a grey one, and a
  // hand before a white wall is not. sum M is then the tile's number of pixels.
  // `region` is one of whole tiles.
  void candidates(const ImageView& frame, const Region& region, double match, const Cut& cut, Mask& out);

 private:
  void histograms(const Region& tiles);  // of one row of tiles, out of columns_ into seen_
  void match_tiles(const Region& tiles, double match);
  void widen(int width);

  const Kernels& kernels_;
  Grid grid_;
  int bins_;
  std::vector<std::uint64_t> model_, seen_;  // a byte a bin
  std::vector<std::uint32_t> columns_;       // four bits a bin
  std::vector<std::uint8_t> found_, wide_;   // a byte a tile; a byte a pixel
};

// How many of a tile's pixels have to be in common.
[[nodiscard]] int needed(double match, int pixels);

}  // namespace enc::segmentation
