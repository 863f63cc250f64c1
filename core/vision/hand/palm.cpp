#include "core/vision/hand/palm.h"

#include <algorithm>
#include <cmath>

namespace enc {

PalmFinder::PalmFinder(int width, int height)
    : columns_(std::max(3, width / kGrid)),
      rows_(std::max(3, height / kGrid)),
      thick_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

// Distances of 3 and 4 for a step and a diagonal one, in two passes [Borgefors 1986].
void PalmFinder::measure(const Mask& skin) {
  std::fill(thick_.begin(), thick_.end(), 0);
  const auto on = [&](int column, int row) {
    return skin.whole().contains(column * kGrid, row * kGrid) && skin.at(column * kGrid, row * kGrid);
  };
  for (int row = 1; row < rows_ - 1; ++row)
    for (int column = 1; column < columns_ - 1; ++column)
      if (on(column, row))
        thick_[at(column, row)] =
            std::min({thick_[at(column - 1, row)] + 3, thick_[at(column, row - 1)] + 3,
                      thick_[at(column - 1, row - 1)] + 4, thick_[at(column + 1, row - 1)] + 4});
  for (int row = rows_ - 2; row > 0; --row)
    for (int column = columns_ - 2; column > 0; --column)
      if (int& here = thick_[at(column, row)]; here > 0)
        here = std::min({here, thick_[at(column + 1, row)] + 3, thick_[at(column, row + 1)] + 3,
                         thick_[at(column + 1, row + 1)] + 4, thick_[at(column - 1, row + 1)] + 4});
}

Pixel PalmFinder::near(const Pixel& tip, double far) const {
  constexpr double kAbout = 0.88;
  const auto off = [&](int column, int row) {
    return std::hypot(column * kGrid - tip.column, row * kGrid - tip.row);
  };
  int most = 0;
  const auto each = [&](const auto& look) {
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column)
        if (const int thick = thick_[at(column, row)]; thick > 0 && off(column, row) < far)
          look(column, row, thick);
  };
  each([&](int, int, int thick) { most = std::max(most, thick); });
  Pixel nearest;
  double least = far;
  each([&](int column, int row, int thick) {
    if (thick < kAbout * most || off(column, row) >= least) return;
    least = off(column, row);
    nearest = {static_cast<double>(column * kGrid), static_cast<double>(row * kGrid)};
  });
  return nearest;
}

}  // namespace enc
