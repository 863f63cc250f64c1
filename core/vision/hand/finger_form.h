// What a fingertip is the end of, as the mask of skin shows it: a finger of some length, and then a hand, the
// image's border, or nothing.
#pragma once

#include <array>
#include <cstdint>

#include "core/vision/finger/fingertip.h"

namespace enc {

enum class FormEnd : std::uint8_t { nothing, border, hand };

struct FingerForm {
  double width = kUnset;   // px, across the finger: the middle one of those behind the cap
  double length = kUnset;  // px, from the far end of the cap to where the finger ends
  FormEnd end = FormEnd::nothing;
  // Places of the finger's middle line, evenly from the cap to its end.
  static constexpr std::size_t kSpots = 6;
  std::array<Pixel, kSpots> spots;
};

// `reach`, in radii of the outline: how far behind the tip is looked, at most. The mask counts within
// form_region() alone, so that it is the same whatever was segmented beyond.
[[nodiscard]] FingerForm form_of(const Mask& skin, const Fingertip& tip, double reach);
[[nodiscard]] Region form_region(const Fingertip& tip, double reach, const Region& image);

}  // namespace enc
