#include "core/vision/segmentation/dim.h"

#include <algorithm>

#include "core/vision/segmentation/kernels/arc.h"
#include "core/vision/segmentation/kernels/hue.h"

namespace enc::segmentation {
namespace {

struct Sum {
  int n = 0;
  int rgb[3] = {0, 0, 0};
};

Sum around(const ImageView& frame, const Mask& dim, int x, int y) {
  const int x0 = std::max(0, x - kDimAround), x1 = std::min(frame.width - 1, x + kDimAround);
  const int y0 = std::max(0, y - kDimAround), y1 = std::min(frame.height - 1, y + kDimAround);
  Sum sum;
  for (int v = y0; v <= y1; ++v) {
    const std::uint8_t* on = dim.row(v);
    const std::uint8_t* p = frame.at(x0, v);
    for (int u = x0; u <= x1; ++u, p += 3) {
      if (on[u] == 0) continue;
      ++sum.n;
      for (int c = 0; c < 3; ++c) sum.rgb[c] += p[c];
    }
  }
  return sum;
}

bool is_skin(const Sum& sum, const std::uint16_t (&white)[3], const Cut& cut) {
  const auto whiter = [&](int c) { return (sum.rgb[c] * white[c] + 128) >> 8; };
  const int r = whiter(0), g = whiter(1), b = whiter(2);
  const int most = std::max(r, std::max(g, b)), least = std::min(r, std::min(g, b)), chroma = most - least;
  return chroma * chroma >= sum.n * cut.least_chroma * cut.least_chroma &&
         most * most >= sum.n * cut.least_value * cut.least_value && kLeastSaturation * chroma >= most &&
         in_cut(hue_of_any(r, g, b, most, least), cut);
}

}  // namespace

void find_dim(const ImageView& frame, const Mask& dim, const Region& region, const std::uint16_t (&white)[3],
              const Cut& cut, Mask& skin) {
  for (int y = region.y0; y < region.y1; ++y) {
    const std::uint8_t* on = dim.row(y);
    std::uint8_t* out = skin.row(y);
    for (int x = region.x0; x < region.x1; ++x)
      if (on[x] != 0 && is_skin(around(frame, dim, x, y), white, cut)) out[x] = 255;
  }
}

}  // namespace enc::segmentation
