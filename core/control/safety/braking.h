// How fast something may be that has to stop in time.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/frames.h"

namespace enc {

// Largest speed from which a machine still stops within `distance`, in steps of dt.
[[nodiscard]] inline double braking_speed(double distance, double acceleration, double dt) {
  const double unit = acceleration * dt;
  return unit * (std::sqrt(0.25 + 2.0 * distance / (unit * dt)) - 0.5);
}

// Speed towards something at a distance, such that a machine can still stop there.
[[nodiscard]] inline double approach_speed(double distance, double acceleration, double dt) {
  return std::min(0.5 * distance / dt, braking_speed(distance, acceleration, dt));
}

// The straight way to where something comes to rest that goes at `velocity` for one more tick and then
// brakes.
[[nodiscard]] inline Vec3 braking_way(const Vec3& velocity, double acceleration, double dt) {
  return dt * velocity + velocity * (velocity.norm() / (2.0 * acceleration));
}

// A velocity with its size reduced by `less`, not below zero.
[[nodiscard]] inline Vec3 slowed(const Vec3& velocity, double less) {
  const double size = velocity.norm();
  return size > less ? Vec3(velocity * (1.0 - less / size)) : Vec3(Vec3::Zero());
}

}  // namespace enc
