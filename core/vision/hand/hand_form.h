// The form of a hand in the mask of skin: the finger behind a fingertip, and the palm.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/frames.h"
#include "core/base/image.h"
#include "core/vision/finger/fingertip.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

// The median of a few measurements, in place. The upper median for an even number; NaN for an empty span.
// Reorders the values.
[[nodiscard]] inline double upper_median(std::span<double> values) {
  if (values.empty()) return kUnset;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

enum class FormEnd : std::uint8_t { nothing, border, hand };

// The form behind a fingertip in the mask of skin: a finger of some length, and then a hand, the image's
// border, or nothing.
struct FingerForm {
  // px, across the finger: median of the widths behind the cap.
  double width = kUnset;
  // px, from the far end of the cap to the finger's end.
  double length = kUnset;
  FormEnd end = FormEnd::nothing;
  // Points of the finger's middle line, evenly from the cap to its end.
  static constexpr std::size_t kSpots = 6;
  std::array<Pixel, kSpots> spots;
};

// `reach`, in radii of the outline: largest distance examined behind the tip. Only the mask within
// form_region() counts, so that the result does not depend on what was segmented beyond.
[[nodiscard]] FingerForm form_of(const Mask& skin, const Fingertip& tip, double reach);
[[nodiscard]] Region form_region(const Fingertip& tip, double reach, const Region& image);

// The thickest place of the skin near a fingertip, on a coarse grid: the palm of its hand.
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
