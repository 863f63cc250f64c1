// The one grid of tiles of an image, from its upper left; the last column and row may be narrower.
#pragma once

#include "core/base/image.h"

namespace enc::segmentation {

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

}  // namespace enc::segmentation
