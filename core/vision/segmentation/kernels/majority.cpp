#include "core/vision/segmentation/kernels/majority.h"

#include <algorithm>
#include <cstddef>

namespace enc::segmentation {

Majority::Majority(const Kernels& kernels, int side, int width)
    : kernels_(kernels), side_(side), sums_(static_cast<std::size_t>(width + 2 * side)) {}

void Majority::filter(const Mask& in, const Region& region, Mask& out) {
  if (region.empty()) return;
  const int r = margin();
  const int from = std::max(0, region.x0 - r), to = std::min(in.width, region.x1 + r);
  const int left = from - (region.x0 - r), right = region.x1 + r - to;  // columns beyond the image
  const auto row = [&](int y) { return in.row(std::clamp(y, 0, in.height - 1)) + from; };
  std::uint8_t* const sums = sums_.data() + left;
  std::fill(sums_.begin(), sums_.end(), std::uint8_t{0});
  for (int y = region.y0 - r; y < region.y0 + r; ++y) kernels_.slide(row(y), nullptr, to - from, sums);
  for (int y = region.y0; y < region.y1; ++y) {
    kernels_.slide(row(y + r), y > region.y0 ? row(y - r - 1) : nullptr, to - from, sums);
    std::fill(sums_.data(), sums, sums[0]);
    std::fill(sums + (to - from), sums + (to - from) + right, sums[to - from - 1]);
    kernels_.majority_row(sums_.data(), region.width(), side_, out.row(y) + region.x0);
  }
}

}  // namespace enc::segmentation
