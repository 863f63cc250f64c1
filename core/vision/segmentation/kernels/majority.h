// The median of a mask: what more than half of a square window has. Beyond the image's edge stands the
// pixel at the edge.
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
  // Within `region`; of `in` what lies up to margin() outside of it is read, too.
  void filter(const Mask& in, const Region& region, Mask& out);

 private:
  const Kernels& kernels_;
  int side_;
  std::vector<std::uint8_t> sums_;  // of the window's rows, a column each
};

}  // namespace enc::segmentation
