// The form behind a fingertip in the mask of skin: a finger of some length, and then a hand, the image's
// border, or nothing.
#pragma once

#include <array>
#include <cstdint>

#include "core/vision/finger/fingertip.h"

namespace enc {

enum class FormEnd : std::uint8_t { nothing, border, hand };

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

}  // namespace enc
