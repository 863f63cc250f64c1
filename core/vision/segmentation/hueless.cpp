#include "core/vision/segmentation/hueless.h"

#include <algorithm>

#include "core/vision/segmentation/kernels/arc.h"
#include "core/vision/segmentation/kernels/hue.h"

namespace enc::segmentation {
namespace {

// Derived from the twin's skins, whose chroma is 0.45 of the brightest channel or more: at least one in so
// many. It keeps away what is bright as well, so that no time is lost with that.
constexpr int kLeastSaturation = 4;
constexpr int kNoise = 8;  // of one pixel's chroma, for the first look, which leaves the light's colour in
constexpr HueRule kOfBackground{.least_chroma = 4, .least_value = 0};  // ten frames: a third of the noise

bool may_be_skin(const std::uint8_t* p) {
  const int most = std::max(p[0], std::max(p[1], p[2])), least = std::min(p[0], std::min(p[1], p[2]));
  return kLeastSaturation * (most - least + kNoise) >= most;
}

bool of_skins_hue(const Planes& background, std::size_t at, const Cut& cut) {
  return in_cut(hue_of(background.red[at], background.green[at], background.blue[at], kOfBackground), cut);
}

}  // namespace

void Hueless::add_row(const ImageView& frame, const Mask& hueless, int y, int sign, int x0, int x1) {
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

bool Hueless::is_skin(const Sum& sum, const std::uint16_t (&white)[3], const Cut& cut) {
  const auto whiter = [&](std::size_t c) { return (sum.rgb[c] * white[c] + 128) >> 8; };
  const int r = whiter(0), g = whiter(1), b = whiter(2);
  const int most = std::max(r, std::max(g, b)), least = std::min(r, std::min(g, b)), chroma = most - least;
  return chroma * chroma >= sum.n * cut.least_chroma * cut.least_chroma &&
         2 * most >= sum.n * cut.least_value && kLeastSaturation * chroma >= most &&
         in_cut(hue_of_any(r, g, b, most, least), cut);
}

void Hueless::find(const ImageView& frame, const Planes& background, const Mask& hueless,
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

}  // namespace enc::segmentation
