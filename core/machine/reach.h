// What a position-controlled machine can do: where it gets, how fast, how hard it speeds up.
#pragma once

#include "core/machine/hexapod.h"

namespace enc {

// What carries the haptic-tip from below: bodies round about H's z axis, each from its depth below H down to
// the next one. A tool that comes from there meets them first.
struct Mount {
  double stem_radius = 0.0;                               // from H on, m
  double gripper_depth = kUnset, gripper_radius = 0.0;    // m
  double platform_depth = kUnset, platform_radius = 0.0;  // m
};

struct Reach {
  double speed = kUnset;         // of the tip, m/s [VHMR 2]
  double acceleration = kUnset;  // of the tip, m/s^2
  Hexapod machine{HexapodGeometry{}};
  Mount mount{};

  [[nodiscard]] bool contains(const Pose<'R', 'H'>& X_RH) const noexcept {
    return machine.limit(X_RH) == ReachLimit::none;
  }
};

}  // namespace enc
