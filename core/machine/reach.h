// Abilities of a position-controlled machine: its reach, speed and acceleration.
#pragma once

#include "core/machine/hexapod.h"

namespace enc {

// The parts below the haptic-tip: bodies of revolution about H's z axis, each from its depth below H down to
// the next one. A tool that comes from below meets them first.
struct Mount {
  double stem_radius = 0.0;                               // starts at H, m
  double gripper_depth = kUnset, gripper_radius = 0.0;    // m
  double platform_depth = kUnset, platform_radius = 0.0;  // m
};

struct Reach {
  double speed = kUnset;         // tip speed, m/s [VHMR 2]
  double acceleration = kUnset;  // tip acceleration, m/s^2
  Hexapod machine{HexapodGeometry{}};
  Mount mount{};

  [[nodiscard]] bool contains(const Pose<'R', 'H'>& X_RH) const noexcept {
    return machine.limit(X_RH) == ReachLimit::none;
  }
};

}  // namespace enc
