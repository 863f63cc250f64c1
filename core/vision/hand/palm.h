// The thickest place of the skin near a fingertip, on a coarse grid: the palm of its hand.
#pragma once

#include <vector>

#include "core/base/image.h"
#include "core/vision/stereo/lens.h"

namespace enc {

class PalmFinder {
 public:
  static constexpr int kGrid = 4;  // px
  PalmFinder(int width, int height);

  // Measures the distance from each grid point to the next one without skin, or to the image's border.
  void measure(const Mask& skin);
  // Among the places within `far` px of the tip that are about as thick as the thickest, the nearest one. NaN
  // without skin.
  [[nodiscard]] Pixel near(const Pixel& tip, double far) const;

 private:
  [[nodiscard]] std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  int columns_ = 0, rows_ = 0;
  std::vector<int> thick_;  // thirds of the grid's step
};

}  // namespace enc
