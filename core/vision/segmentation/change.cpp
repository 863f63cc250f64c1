#include "core/vision/segmentation/change.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace enc::segmentation {
namespace {

constexpr double kLeastColour = 0.004, kLeastBright = 0.01;  // shares: a steady lamp's flicker
constexpr double kSpreads = 3.0;                             // of what the light leaves unexplained

template <class T>
T fixed(double value, double one) {
  return static_cast<T>(std::clamp(std::floor(value * one + 0.5), 0.0, double{static_cast<T>(-1)}));
}

Explained explained(const Light& light, double change) {
  Explained e{};
  const auto& g = light.gain;
  const double least = std::min(g[0], std::min(g[1], g[2]));
  for (std::size_t c = 0; c < 3; ++c) {
    e.gain[c] = fixed<std::uint16_t>(g[c], 1024.0);
    e.white[c] = fixed<std::uint16_t>(least / g[c], 256.0);
  }
  e.noise = fixed<std::uint16_t>(change, 0.5 * 256.0);  // of eighths to quarters
  e.colour = fixed<std::uint16_t>(kLeastColour + kSpreads * light.colour, 65536.0);
  e.bright = fixed<std::uint16_t>(kLeastBright + kSpreads * light.bright, 65536.0);
  return e;
}

}  // namespace

Change::Change(const Kernels& kernels, const Grid& grid, const Image& mean, const std::vector<double>& noise)
    : kernels_(kernels),
      grid_(grid),
      side_(static_cast<std::size_t>(grid.width)),
      meter_(mean, grid),
      surroundings_(kernels, kSurroundings, grid.width),
      by_sums_(grid.width),
      strong_(grid.width, grid.height),
      skin_(grid.width, grid.height),
      hueless_(grid.width, grid.height),
      near_(grid.width, grid.height) {
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const std::uint8_t* p = mean.view().at(x, y);
      background_.red.push_back(p[0]);
      background_.green.push_back(p[1]);
      background_.blue.push_back(p[2]);
      noise_.push_back(fixed<std::uint8_t>(
          noise[static_cast<std::size_t>(y / grid.tile * grid.columns() + x / grid.tile)], 8.0));
    }
}

// The same for all rows of a tile, wherever the region begins.
void Change::row_of(const Light& light, int y, const Region& region) {
  const double one = 16384.0 * 65536.0;
  const int tile = y / grid_.tile;
  const double down = light.down * ((tile + 0.5) * grid_.tile / grid_.height - 0.5);
  const double first = light.middle + down - 0.5 * light.across;
  const auto step = static_cast<std::int64_t>(one * light.across / grid_.width);
  auto at = static_cast<std::int64_t>(one * first) + step * region.x0;
  for (int x = region.x0; x < region.x1; ++x, at += step)
    side_[static_cast<std::size_t>(x)] =
        static_cast<std::uint16_t>(std::clamp<std::int64_t>(at >> 16, 0, 65535));
}

void Change::candidates(const ImageView& frame, const Region& region, double change, const Cut& cut,
                        Mask& out) {
  const Light light = meter_.measure(frame);
  const Explained how = explained(light, change);
  const Region wide = grid_.touched(region, surroundings_.margin());
  const Region widest = grid_.touched(wide, Hueless::kAround);
  for (int y = widest.y0; y < widest.y1; ++y) {
    if (y == widest.y0 || y % grid_.tile == 0) row_of(light, y, widest);
    const int x = widest.x0;
    const auto at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.width) + static_cast<std::size_t>(x);
    const ChangeRow row{frame.at(x, y),
                        background_.red.data() + at,
                        background_.green.data() + at,
                        background_.blue.data() + at,
                        noise_.data() + at,
                        side_.data() + x};
    kernels_.change_row(row, widest.width(), how, cut, strong_.row(y) + x, skin_.row(y) + x,
                        hueless_.row(y) + x);
  }
  by_sums_.find(frame, background_, hueless_, wide, how.white, cut, strong_);
  surroundings_.filter(strong_, region, near_);
  for (int y = region.y0; y < region.y1; ++y)
    kernels_.join_row(strong_.row(y) + region.x0, near_.row(y) + region.x0, skin_.row(y) + region.x0,
                      region.width(), out.row(y) + region.x0);
}

}  // namespace enc::segmentation
