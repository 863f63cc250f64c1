// A force that stays constant while the deflection grows: a sensor at its limit, or an object that yields.
#pragma once

#include <cmath>
#include <span>

#include "core/base/frames.h"
#include "models/identify/response/response_fit.h"

namespace enc::models {

// Deflection, m, and time, s, at which the force stops rising; unset: it rises to the deepest reading.
struct Plateau {
  double from = kUnset, time = kUnset;
};

// Takes the readings of one press, of either branch, in order of time.
[[nodiscard]] Plateau plateau_of(std::span<const LoopPoint> moving);

}  // namespace enc::models
