// The hue of a pixel in exact integers: 0 to 1535 once around the circle, 256 to each of its six sextants,
// with red at 0, yellow at 256, green at 512, blue at 1024. Within a sextant it is floor(256 d / chroma).
// chroma = most - least of R, G, B; d is the distance of the middle one from the sextant's start.
//
// If the chroma or the brightest channel is below HueRule, the hue is that of the noise: the pixel has no
// hue. It is then in no bin of hue, and not skin by itself (Hueless of change.h). [VisHap 2.1.1] has no rule
// for it. The chroma decides the accuracy of a hue, however dark the pixel: skin with a brightest channel of
// 20 has a chroma of 12.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "core/spec/vision_rig.h"
#include "core/vision/segmentation/kernels/kernels.h"

namespace enc::segmentation {

inline constexpr int kHues = 1536, kSextant = 256;
inline constexpr int kNoHue = -1;

namespace detail {

// Sextant and d / chroma.
struct Position {
  int sextant = 0, d = 0, chroma = 0;
};
inline Position position_of(int r, int g, int b, int most, int least) {
  const int chroma = most - least;
  if (r == most && b == least) return {0, g - b, chroma};
  if (g == most && b == least) return {1, g - r, chroma};
  if (g == most && r == least) return {2, b - r, chroma};
  if (b == most && r == least) return {3, b - g, chroma};
  if (b == most && g == least) return {4, r - g, chroma};
  return {5, r - b, chroma};
}

}  // namespace detail

[[nodiscard]] inline bool has_hue(int most, int least, const HueRule& rule) {
  return most - least >= std::max<int>(1, rule.least_chroma) && most >= rule.least_value;
}

// The hue without HueRule, for any numbers, such as sums of pixels; they must not all be equal.
[[nodiscard]] inline int hue_of_any(int r, int g, int b, int most, int least) {
  const auto at = detail::position_of(r, g, b, most, least);
  return (kSextant * at.sextant + kSextant * at.d / at.chroma) % kHues;
}

[[nodiscard]] inline int hue_of(int r, int g, int b, const HueRule& rule) {
  const int most = std::max(r, std::max(g, b)), least = std::min(r, std::min(g, b));
  if (!has_hue(most, least, rule)) return kNoHue;
  return hue_of_any(r, g, b, most, least);
}

// That hue before rounding down, rad, 0 to 2 pi; only for a pixel that has a hue.
[[nodiscard]] inline double exact_hue(int r, int g, int b) {
  const auto at = detail::position_of(r, g, b, std::max(r, std::max(g, b)), std::min(r, std::min(g, b)));
  return (at.sextant + static_cast<double>(at.d) / at.chroma) * (std::numbers::pi / 3.0);
}

// The centre of the interval of `hue`, rad, 0 to 2 pi.
[[nodiscard]] inline double angle_of(int hue) { return (hue + 0.5) * (2.0 * std::numbers::pi / kHues); }

// The skin's part of the circle of hue. Hues `first` to `first + count - 1`, modulo kHues.
struct Arc {
  int first = 0, count = 0;
  [[nodiscard]] bool has(int hue) const { return hue != kNoHue && (hue - first + kHues) % kHues < count; }
};

// A probability above a threshold is a distance below a limit: at most `spreads` spreads from the mean.
[[nodiscard]] Arc skin_arc(const SkinModel& model, double spreads);

// The form that the kernels take.
[[nodiscard]] Cut cut_of(const Arc& arc, const HueRule& rule);
[[nodiscard]] bool in_cut(int hue, const Cut& cut);  // false for kNoHue

}  // namespace enc::segmentation
