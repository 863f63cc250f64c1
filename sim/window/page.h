// A page of tiles in a window, each a picture with a name, for a choice.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/base/image.h"

namespace enc::sim {

struct ViewTile {
  Image picture;  // empty: no picture yet
  std::string name;
};
struct ViewPage {
  std::string title, line;  // above the tiles and below them
  std::vector<ViewTile> tiles;
  std::size_t chosen = 0;
};

// Positions of the tiles, px from the window's upper left corner.
struct TileGrid {
  static constexpr double kWidest = 1.4;                             // tile's width over its height
  static constexpr double kGap = 6.0, kName = 24.0, kMargin = 34.0;  // px; the margin: above and below
  std::size_t columns = 1;
  double width = 1.0, height = 1.0;  // tile with its name and gap

  TileGrid(std::size_t tiles, double window_width, double window_height) {
    const double room = std::max(1.0, window_height - 2.0 * kMargin);
    for (;; ++columns) {
      const std::size_t rows = std::max<std::size_t>(1, (tiles + columns - 1) / columns);
      width = window_width / static_cast<double>(columns);
      height = room / static_cast<double>(rows);
      if (width <= kWidest * height || columns >= tiles) return;
    }
  }
  [[nodiscard]] double left(std::size_t i) const { return width * static_cast<double>(i % columns); }
  [[nodiscard]] double top(std::size_t i) const {
    const std::size_t row = i / columns;
    return kMargin + height * static_cast<double>(row);
  }
  // Size of the picture in a tile.
  [[nodiscard]] int picture_width() const { return std::max(1, static_cast<int>(width - kGap)); }
  [[nodiscard]] int picture_height() const { return std::max(1, static_cast<int>(height - kGap - kName)); }
  // The tile at (x, y), or `none`.
  [[nodiscard]] std::size_t at(double x, double y, std::size_t tiles, std::size_t none) const {
    if (x < 0.0 || y < kMargin) return none;
    const auto column = static_cast<std::size_t>(x / width),
               row = static_cast<std::size_t>((y - kMargin) / height);
    const std::size_t i = row * columns + column;
    return column < columns && i < tiles ? i : none;
  }
};

}  // namespace enc::sim
