// Images of vision: colour images, masks, regions. Pixels are (x, y) = (column, row) from the upper left; the
// centre of the first pixel is (0, 0).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace enc {

// A view of RGB bytes: three a pixel, rows from the top, without padding. The image's owner keeps the bytes.
struct ImageView {
  const std::uint8_t* rgb = nullptr;
  int width = 0, height = 0;

  [[nodiscard]] const std::uint8_t* at(int x, int y) const {
    return rgb +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

// px
struct ImageSize {
  int width = 0, height = 0;
  bool operator==(const ImageSize&) const = default;
};

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  [[nodiscard]] ImageView view() const { return {rgb.data(), width, height}; }
  [[nodiscard]] std::uint8_t* at(int x, int y) {
    return rgb.data() +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

// Columns x0 to x1 and rows y0 to y1; x1 and y1 are excluded.
struct Region {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] bool empty() const { return x1 <= x0 || y1 <= y0; }
  [[nodiscard]] int width() const { return std::max(0, x1 - x0); }
  [[nodiscard]] int height() const { return std::max(0, y1 - y0); }
  [[nodiscard]] std::int64_t pixels() const { return std::int64_t{width()} * height(); }
  [[nodiscard]] bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  [[nodiscard]] Region cut(const Region& to) const {
    return {std::max(x0, to.x0), std::max(y0, to.y0), std::min(x1, to.x1), std::min(y1, to.y1)};
  }
  bool operator==(const Region&) const = default;
};

// A mask: 255 marks a pixel as set, 0 as clear.
struct Mask {
  int width = 0, height = 0;
  std::vector<std::uint8_t> on;

  Mask() = default;
  Mask(int w, int h) : width(w), height(h), on(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  [[nodiscard]] const std::uint8_t* row(int y) const {
    return on.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
  [[nodiscard]] std::uint8_t* row(int y) {
    return on.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
  [[nodiscard]] bool at(int x, int y) const { return row(y)[x] != 0; }
  [[nodiscard]] Region whole() const { return {0, 0, width, height}; }
};

}  // namespace enc
