// The median of a mask: the majority in a square window. Beyond the image's edge, the edge pixel continues.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/kernels/kernels.h"

namespace enc::segmentation {

class Majority {
 public:
  Majority(const Kernels& kernels, int side, int width);
  [[nodiscard]] int margin() const { return side_ / 2; }
  // Filters within `region`; also reads `in` up to margin() outside of it.
  void filter(const Mask& in, const Region& region, Mask& out);

 private:
  const Kernels& kernels_;
  int side_;
  std::vector<std::uint8_t> sums_;  // sums over the window's rows, one for each column
};

}  // namespace enc::segmentation
