// The display as the core sees it [VHMR 3.5]. A part of rig_spec.h.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/words.h"

namespace enc {

// The tool tip that deforms the shown surface (fuse.h).
enum class SeenTip : std::uint8_t {
  tracked,    // newest tracked pose, uncorrected for its age, as in the paper [VHMR 3.5]
  predicted,  // the haptic loop's prediction (TrackerRig::prediction)
  fused       // predicted; while it presses, by the haptic-tip's position
};
constexpr auto words(SeenTip) { return enum_words("tracked", "predicted", "fused"); }

struct DisplayRig {
  std::string driver = "sim";
  SeenTip tip = SeenTip::predicted;
  // `fused` only: time ahead of now, the mean age of a surface while it is seen, s; and the compliance of
  // tool and haptic-tip where they touch, m/N.
  double lead = 0.0, compliance = 0.0;
  double overdue = 0.200;       // s: an older surface causes a hold
  double margin = 0.0008;       // m: tracker and drawing error allowed between shown and rendered surface
  double margin_speed = 0.050;  // m/s: growth of that margin with the surface's age
};

}  // namespace enc
