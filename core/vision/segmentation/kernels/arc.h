// The skin's part of the circle of hue.
#pragma once

#include "core/spec/vision/segmentation_spec.h"
#include "core/vision/segmentation/kernels/hue.h"
#include "core/vision/segmentation/kernels/kernels.h"

namespace enc::segmentation {

// Hues `first` to `first + count - 1`, modulo kHues.
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
