#include "core/vision/segmentation/change.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/vision/segmentation/kernels/hue.h"

namespace enc::segmentation {
namespace {

// Least chroma of skin as a share of the brightest channel, inverted; derived from the twin's skins, which
// have 0.45 or more. It also rejects bright pixels early, which saves time.
constexpr int kLeastSaturation = 4;
constexpr int kNoise = 8;  // noise of one pixel's chroma, for the first test, which keeps the light's colour
// averaging ten frames leaves a third of the noise
constexpr HueRule kOfBackground{.least_chroma = 4, .least_value = 0};

bool may_be_skin(const std::uint8_t* p) {
  const int most = std::max(p[0], std::max(p[1], p[2])), least = std::min(p[0], std::min(p[1], p[2]));
  return kLeastSaturation * (most - least + kNoise) >= most;
}

bool of_skins_hue(const Planes& background, std::size_t at, const Cut& cut) {
  return in_cut(hue_of(background.red[at], background.green[at], background.blue[at], kOfBackground), cut);
}

}  // namespace

void HuelessChange::add_row(const ImageView& frame, const Mask& hueless, int y, int sign, int x0, int x1) {
  if (y < 0 || y >= frame.height) return;
  const std::uint8_t* on = hueless.row(y);
  const std::uint8_t* p = frame.at(x0, y);
  for (int x = x0; x < x1; ++x, p += 3) {
    if (on[x] == 0) continue;
    Sum& sum = columns_[static_cast<std::size_t>(x)];
    sum.n += sign;
    for (std::size_t c = 0; c < 3; ++c) sum.rgb[c] += sign * p[c];
  }
}

bool HuelessChange::is_skin(const Sum& sum, const std::uint16_t (&white)[3], const Cut& cut) {
  const auto whiter = [&](std::size_t c) { return (sum.rgb[c] * white[c] + 128) >> 8; };
  const int r = whiter(0), g = whiter(1), b = whiter(2);
  const int most = std::max(r, std::max(g, b)), least = std::min(r, std::min(g, b)), chroma = most - least;
  return chroma * chroma >= sum.n * cut.least_chroma * cut.least_chroma &&
         2 * most >= sum.n * cut.least_value && kLeastSaturation * chroma >= most &&
         in_cut(hue_of_any(r, g, b, most, least), cut);
}

void HuelessChange::find(const ImageView& frame, const Planes& background, const Mask& hueless,
                         const Region& region, const std::uint16_t (&white)[3], const Cut& cut, Mask& skin) {
  const int x0 = std::max(0, region.x0 - kAround), x1 = std::min(frame.width, region.x1 + kAround);
  std::fill(columns_.begin() + x0, columns_.begin() + x1, Sum{});
  for (int y = region.y0 - kAround; y < region.y0 + kAround; ++y) add_row(frame, hueless, y, 1, x0, x1);
  for (int y = region.y0; y < region.y1; ++y) {
    add_row(frame, hueless, y + kAround, 1, x0, x1);
    const std::uint8_t* on = hueless.row(y);
    for (int x = region.x0; x < region.x1; ++x) {
      if (on[x] == 0 || !may_be_skin(frame.at(x, y))) continue;
      Sum sum;
      for (int u = std::max(x0, x - kAround); u <= std::min(x1 - 1, x + kAround); ++u) {
        const Sum& column = columns_[static_cast<std::size_t>(u)];
        sum.n += column.n;
        for (std::size_t c = 0; c < 3; ++c) sum.rgb[c] += column.rgb[c];
      }
      const auto at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
      if (is_skin(sum, white, cut) && !of_skins_hue(background, at, cut)) skin.row(y)[x] = 255;
    }
    add_row(frame, hueless, y - kAround, -1, x0, x1);
  }
}

namespace {

constexpr double kLeastColour = 0.004, kLeastBright = 0.01;  // shares: a steady lamp's flicker
constexpr double kSpreads = 3.0;                             // times the light's residual

template <class T>
T fixed(double value, double one) {
  return static_cast<T>(std::clamp(std::floor(value * one + 0.5), 0.0, double{static_cast<T>(-1)}));
}

FrameLight explained(const Light& light, double change) {
  FrameLight e{};
  const auto& g = light.gain;
  const double least = std::min(g[0], std::min(g[1], g[2]));
  for (std::size_t c = 0; c < 3; ++c) {
    e.gain[c] = fixed<std::uint16_t>(g[c], 1024.0);
    e.white[c] = fixed<std::uint16_t>(least / g[c], 256.0);
  }
  e.noise = fixed<std::uint16_t>(change, 0.5 * 256.0);  // converts eighths to quarters
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

// Equal for all rows of a tile, wherever the region begins.
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
  const FrameLight how = explained(light, change);
  const Region wide = grid_.touched(region, surroundings_.margin());
  const Region widest = grid_.touched(wide, HuelessChange::kAround);
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
