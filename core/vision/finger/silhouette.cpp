#include "core/vision/finger/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace enc {
namespace {

constexpr double kRound = 1.8;         // radii of the cap round its middle that are laid over
constexpr int kMostPixels = 1024;      // pixels of it, evenly spread
constexpr double kAboutAsGood = 0.04;  // share of pixels
constexpr double kTells = 0.1;         // share: where all shifts are alike nothing is told
constexpr int kApart = 4;              // px

struct Lay {
  int x0, x1, y0, y1, step;
  Lay(const Fingertip& tip, const Region& image) {
    const double far = kRound * tip.outline;
    const Region box = Region{static_cast<int>(tip.column - far), static_cast<int>(tip.row - far),
                              static_cast<int>(tip.column + far) + 1, static_cast<int>(tip.row + far) + 1}
                           .cut(image);
    x0 = box.x0, x1 = box.x1, y0 = box.y0, y1 = box.y1;
    step =
        std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(box.pixels()) / kMostPixels))));
  }
};

// Share of the pixels that are skin in both or in neither; what lies outside of the right image is not.
double alike(const Mask& left, const Mask& right, const Lay& lay, int shift) {
  int same = 0, all = 0;
  for (int y = lay.y0; y < lay.y1; y += lay.step)
    for (int x = lay.x0; x < lay.x1; x += lay.step, ++all)
      same += x >= shift && left.at(x, y) == right.at(x - shift, y) ? 1 : 0;
  return all == 0 ? 0.0 : static_cast<double>(same) / all;
}

}  // namespace

Region opposite(const Fingertip& tip, const ShiftRange& range, const Region& image) {
  const Lay lay(tip, image);
  return Region{lay.x0 - range.most, lay.y0, lay.x1 - range.least, lay.y1}.cut(image);
}

std::size_t alike_shapes(const Mask& left, const Mask& right, const Fingertip& tip, const ShiftRange& range,
                         std::span<float> shifts) {
  const Lay lay(tip, left.whole());
  std::array<double, 512> share{};
  const int most = std::min(range.most, range.least + static_cast<int>(share.size()) - 1);
  const auto of = [&](int shift) -> double& { return share[static_cast<std::size_t>(shift - range.least)]; };
  double best = 0.0, worst = 1.0;
  for (int shift = range.least; shift <= most; ++shift) {
    of(shift) = alike(left, right, lay, shift);
    best = std::max(best, of(shift));
    if (shift <= lay.x0) worst = std::min(worst, of(shift));  // all of it is in the image
  }
  if (best - worst < kTells) return 0;
  std::size_t count = 0;
  for (; count < shifts.size(); ++count) {
    int top = range.least;
    for (int shift = range.least; shift <= most; ++shift)
      if (of(shift) > of(top)) top = shift;
    if (!(of(top) > 0.0) || of(top) < best - kAboutAsGood) break;
    shifts[count] = static_cast<float>(top);
    for (int shift = std::max(range.least, top - kApart); shift <= std::min(most, top + kApart); ++shift)
      of(shift) = 0.0;
  }
  return count;
}

}  // namespace enc
