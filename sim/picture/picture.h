// Drawing on images, and writing them to a file.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/base/image.h"

namespace enc::sim {

using Ink = std::array<std::uint8_t, 3>;

void flip(Image& picture);  // OpenGL's first row is the lowest
// A straight stroke of a width, in pixels, with a round dot of `dot` pixels radius at its end.
void stroke(Image& picture, double x0, double y0, double x1, double y1, double width, double dot, Ink ink);
// Brightens dark pixels from (x0, y0) to (x1, y1) enough for dark text on them.
void brighten(Image& picture, double x0, double y0, double x1, double y1);
// Inks the picture wherever the mask is bright.
void ink_through(Image& picture, const Image& mask, Ink ink);
[[nodiscard]] Image shrunk(const Image& picture, int factor);  // mean of factor x factor pixels
[[nodiscard]] std::string png(const Image& picture);           // bytes of a PNG; throws Error

}  // namespace enc::sim
