// A picture in memory, three bytes for each pixel, first row at the top.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace enc::sim {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  Picture() = default;
  Picture(int w, int h)
      : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  [[nodiscard]] std::uint8_t* at(int x, int y) {
    return rgb.data() +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
  [[nodiscard]] const std::uint8_t* at(int x, int y) const { return const_cast<Picture*>(this)->at(x, y); }
};

using Ink = std::array<std::uint8_t, 3>;

void flip(Picture& picture);  // OpenGL's first row is the lowest
// A straight stroke of a width, in pixels, with a round dot of `dot` pixels radius at its end.
void stroke(Picture& picture, double x0, double y0, double x1, double y1, double width, double dot, Ink ink);
// Inks the picture where the mask is bright.
void ink_through(Picture& picture, const Picture& mask, Ink ink);
[[nodiscard]] Picture shrunk(const Picture& picture, int factor);  // mean of factor x factor pixels
[[nodiscard]] std::string png(const Picture& picture);             // its bytes; throws Error

}  // namespace enc::sim
