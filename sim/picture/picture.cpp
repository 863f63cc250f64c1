#include "sim/picture/picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <png.h>

#include "core/base/error.h"

namespace enc::sim {

void flip(Image& picture) {
  const std::size_t row = 3 * static_cast<std::size_t>(picture.width);
  for (int y = 0; y < picture.height / 2; ++y)
    std::swap_ranges(picture.at(0, y), picture.at(0, y) + row, picture.at(0, picture.height - 1 - y));
}

void stroke(Image& picture, double x0, double y0, double x1, double y1, double width, double dot, Ink ink) {
  const double dx = x1 - x0;
  const double dy = y1 - y0;
  const double length2 = std::max(1e-9, dx * dx + dy * dy);
  const double margin = std::max(width, dot) + 1.0;
  const auto whole = [](double v, int most) { return std::clamp(static_cast<int>(v), 0, most - 1); };
  for (int y = whole(std::min(y0, y1) - margin, picture.height);
       y <= whole(std::max(y0, y1) + margin, picture.height); ++y)
    for (int x = whole(std::min(x0, x1) - margin, picture.width);
         x <= whole(std::max(x0, x1) + margin, picture.width); ++x) {
      const double share = std::clamp(((x - x0) * dx + (y - y0) * dy) / length2, 0.0, 1.0);
      const bool on_line = std::hypot(x - x0 - share * dx, y - y0 - share * dy) <= 0.5 * width;
      if (on_line || std::hypot(x - x1, y - y1) <= dot) std::copy(ink.begin(), ink.end(), picture.at(x, y));
    }
}

void brighten(Image& picture, double x0, double y0, double x1, double y1) {
  constexpr std::uint8_t kReadable = 165;
  const auto whole = [](double v, int most) { return std::clamp(static_cast<int>(v), 0, most); };
  for (int y = whole(y0, picture.height); y < whole(y1, picture.height); ++y)
    for (int x = whole(x0, picture.width); x < whole(x1, picture.width); ++x)
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = std::max(picture.at(x, y)[c], kReadable);
}

void ink_through(Image& picture, const Image& mask, Ink ink) {
  for (std::size_t i = 0; i < std::min(picture.rgb.size(), mask.rgb.size()); ++i)
    picture.rgb[i] =
        static_cast<std::uint8_t>((picture.rgb[i] * (255 - mask.rgb[i]) + ink[i % 3] * mask.rgb[i]) / 255);
}

Image shrunk(const Image& picture, int factor) {
  Image small(picture.width / factor, picture.height / factor);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int j = 0; j < factor; ++j)
          for (int i = 0; i < factor; ++i) sum += picture.view().at(x * factor + i, y * factor + j)[c];
        small.at(x, y)[c] = static_cast<std::uint8_t>(sum / (factor * factor));
      }
  return small;
}

// Encodes in memory, because libpng deletes any file that it could not write.
std::string png(const Image& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) == 0)
    throw Error(std::string("the picture cannot be packed (") + image.message +
                "); give the program more memory");
  bytes.resize(size);
  return bytes;
}

namespace {

void spread_column(std::vector<LabelRow*>& column, double pitch, double top, double bottom) {
  std::stable_sort(column.begin(), column.end(),
                   [](const LabelRow* a, const LabelRow* b) { return a->y < b->y; });
  const auto gaps = static_cast<double>(column.size()) - 1.0;
  if (gaps > 0.0) pitch = std::min(pitch, (bottom - top) / gaps);
  double lowest = top;
  for (LabelRow* label : column) {
    label->row = std::max(lowest, label->y);
    lowest = label->row + pitch;
  }
  double highest = bottom;
  for (auto label = column.rbegin(); label != column.rend(); ++label) {
    (*label)->row = std::min(highest, (*label)->row);
    highest = (*label)->row - pitch;
  }
}

// Twice the area of a triangle; its sign is the side of a-b on which c lies.
double side(double ax, double ay, double bx, double by, double cx, double cy) {
  return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

// A line from a to b.
struct Segment {
  double ax, ay, bx, by;
};
bool meet(const Segment& s, const Segment& t) {
  return side(s.ax, s.ay, s.bx, s.by, t.ax, t.ay) * side(s.ax, s.ay, s.bx, s.by, t.bx, t.by) < 0.0 &&
         side(t.ax, t.ay, t.bx, t.by, s.ax, s.ay) * side(t.ax, t.ay, t.bx, t.by, s.bx, s.by) < 0.0;
}

bool cross(const LabelRow& a, const LabelRow& b) {
  const Segment line_a{a.end, a.row, a.x, a.y}, line_b{b.end, b.row, b.x, b.y};
  const Segment text_a{a.edge, a.row, a.end, a.row}, text_b{b.edge, b.row, b.end, b.row};
  return meet(line_a, line_b) || meet(line_a, text_b) || meet(line_b, text_a);
}

// The cost of crossings first, then the length of all lines, px.
double cost(const std::vector<LabelRow*>& column) {
  constexpr double kCrossing = 1e6;
  double sum = 0.0;
  for (std::size_t i = 0; i < column.size(); ++i) {
    sum += std::hypot(column[i]->x - column[i]->end, column[i]->y - column[i]->row);
    for (std::size_t k = i + 1; k < column.size(); ++k)
      if (cross(*column[i], *column[k])) sum += kCrossing;
  }
  return sum;
}

}  // namespace

void spread_rows(std::vector<LabelRow>& labels, double pitch, double top, double bottom) {
  for (const bool left : {true, false}) {
    std::vector<LabelRow*> column;
    for (LabelRow& label : labels)
      if (label.left == left) column.push_back(&label);
    spread_column(column, pitch, top, bottom);
  }
}

void uncross(std::vector<LabelRow>& labels) {
  for (const bool left : {true, false}) {
    std::vector<LabelRow*> column;
    for (LabelRow& label : labels)
      if (label.left == left) column.push_back(&label);
    double least = cost(column);
    for (bool better = true; better;) {
      better = false;
      for (std::size_t i = 0; i < column.size(); ++i)
        for (std::size_t k = i + 1; k < column.size(); ++k) {
          std::swap(column[i]->row, column[k]->row);
          const double now = cost(column);
          better = better || now < least - 1e-6;
          if (now < least - 1e-6)
            least = now;
          else
            std::swap(column[i]->row, column[k]->row);
        }
    }
  }
}

void end_below(LabelRow& label, double from, double clear) {
  if (label.y >= clear || label.row <= clear) return;
  const double share = (label.row - clear) / (label.row - label.y);
  label.x = from + share * (label.x - from);
  label.y = clear;
  label.dot = false;
}

}  // namespace enc::sim
