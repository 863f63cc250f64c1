// A part of a grey image without its finest detail, which is mostly noise.
#pragma once

#include <cstddef>
#include <vector>

#include "core/vision/stereo/grey.h"

namespace enc {

class Smoothed {
 public:
  // Applies that many passes of (1 2 1) / 4 along rows and columns, not rounded: a Gaussian whose variance is
  // half their number, in px^2. Reads `image` as far beyond `part` as there are passes. The result for a
  // pixel does not depend on other requests.
  Smoothed(const Grey& image, const Region& part, int passes);

  // Valid arguments of at(): `part` within the image.
  [[nodiscard]] const Region& part() const { return part_; }
  // The right neighbours in the row follow it in memory.
  [[nodiscard]] const float* at(int x, int y) const {
    return level_.data() + static_cast<std::size_t>(y - read_.y0) * stride_ +
           static_cast<std::size_t>(x - read_.x0);
  }

 private:
  void pass();
  Region part_, read_;
  std::size_t stride_ = 0;
  std::vector<float> level_;
};

}  // namespace enc
