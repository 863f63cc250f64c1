// What a position-controlled machine can do: where it gets, how fast, how hard it speeds up.
#pragma once

#include "core/hexapod.h"

namespace enc {

struct Reach {
  double speed = kUnset;         // of the tip, m/s [VHMR 2]
  double acceleration = kUnset;  // of the tip, m/s^2
  Hexapod machine{HexapodGeometry{}};

  [[nodiscard]] bool contains(const Pose<'R', 'H'>& X_RH) const noexcept {
    return machine.limit(X_RH) == ReachLimit::none;
  }
};

}  // namespace enc
