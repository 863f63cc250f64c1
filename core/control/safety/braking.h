// Speed limits of something that must stop in time.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/frames.h"

namespace enc {

// Largest speed from which a machine still stops within `distance` (m), in steps of dt.
[[nodiscard]] inline double braking_speed(double distance, double acceleration, double dt) {
  const double unit = acceleration * dt;
  return unit * (std::sqrt(0.25 + 2.0 * distance / (unit * dt)) - 0.5);
}

// Largest speed towards something `distance` (m) away from which a machine can still stop in front of it.
[[nodiscard]] inline double approach_speed(double distance, double acceleration, double dt) {
  return std::min(0.5 * distance / dt, braking_speed(distance, acceleration, dt));
}

// Straight displacement to standstill: one more tick at `velocity`, then braking.
[[nodiscard]] inline Vec3 braking_way(const Vec3& velocity, double acceleration, double dt) {
  return dt * velocity + velocity * (velocity.norm() / (2.0 * acceleration));
}

// The velocity with its magnitude reduced by `less`, not below zero.
[[nodiscard]] inline Vec3 slowed(const Vec3& velocity, double less) {
  const double size = velocity.norm();
  return size > less ? Vec3(velocity * (1.0 - less / size)) : Vec3(Vec3::Zero());
}

}  // namespace enc
