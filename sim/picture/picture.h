// Drawing on images, laying out labels in their margins, and writing them to a file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

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

// Layout of a picture's labels: in its margins, below the title, each with a line to its object. Pixels, y
// downwards.
struct LabelRow {
  bool left = false;             // left margin, else right
  double x = 0.0, y = 0.0;       // target of the line; within the picture below `clear` once it is there
  double row = 0.0;              // y of the text's middle
  double edge = 0.0, end = 0.0;  // x of the text: at the margin, and at the start of the line
  bool dot = true;               // dot at the line's end: the object is in view
};

// Orders the rows of both margins by their objects: `pitch` apart, or closer if they would not fit between
// `top` and `bottom`.
void spread_rows(std::vector<LabelRow>& labels, double pitch, double top, double bottom);
// Exchanges rows of a margin while this reduces crossings of lines with lines or text, or shortens the lines.
void uncross(std::vector<LabelRow>& labels);
// Ends the line from `from` (in the label's row) at the height `clear` if it would go on above it.
void end_below(LabelRow& label, double from, double clear);

}  // namespace enc::sim
