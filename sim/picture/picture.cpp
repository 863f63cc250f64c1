#include "sim/picture/picture.h"

#include <algorithm>
#include <cmath>

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

// In memory: libpng takes away the file that it could not write, whatever that is.
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

}  // namespace enc::sim
