// The display as the core sees it [VHMR 3.5]. A part of rig_spec.h.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/words.h"

namespace enc {

// Which tip dents the seen surface (fuse.h).
enum class SeenTip : std::uint8_t {
  tracked,    // of the newest pose, old as it is, as the paper's does [VHMR 3.5]
  predicted,  // where the haptic loop believes the tool to be (TrackerRig::prediction)
  fused       // predicted; while it presses, where the haptic-tip holds it
};
constexpr auto words(SeenTip) { return enum_words("tracked", "predicted", "fused"); }

struct DisplayRig {
  std::string driver = "sim";
  SeenTip tip = SeenTip::predicted;
  // Of `fused`: ahead of now by what a surface is old, in the middle, while it is seen, s; and by how much
  // tool and haptic-tip are believed to give where they touch, m/N.
  double lead = 0.0, compliance = 0.0;
  double overdue = 0.200;       // s: older surfaces mean "hold"
  double margin = 0.0008;       // m: tracker and drawing error allowed between the seen and the felt surface
  double margin_speed = 0.050;  // m/s: how fast that margin grows with the surface's age
};

}  // namespace enc
