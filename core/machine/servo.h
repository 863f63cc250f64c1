// The position servo of a machine: of second order, and no faster or harder than it can. The twin moves by
// it, and a driver whose machine says no more than its position believes it.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/frames.h"

namespace enc {

struct ServoLaw {
  double frequency = 15.0;     // natural, Hz
  double damping = 0.8;        // ratio
  double speed = 0.050;        // m/s
  double acceleration = 0.41;  // m/s^2
};

// What a position-controlled machine answers with, as the rig believes.
struct ServoModel {
  double frequency = kUnset;  // natural, rad/s
  double damping = kUnset;    // ratio
  double delay = 0.0;         // s
  double dt = kUnset;         // s, of the loop
  // s, of an even motion; no belief makes a machine slower than 0.1 s.
  double lag = std::min(0.1, 2.0 * damping / frequency + delay);
  // Of a tick, implicit in the speed, so that no frequency and no dt make it diverge.
  double turn = frequency * dt;                                    // rad
  double pull = frequency * turn;                                  // 1/s, to the command
  double left = 1.0 / (1.0 + 2.0 * damping * turn + turn * turn);  // of the speed
};

// Of one point, in the axes of whoever moves it: m, m/s, m/s^2.
struct ServoMotion {
  Vec3 p{0, 0, 0}, velocity{0, 0, 0}, acceleration{0, 0, 0};
};

// Into so many steps a time is cut: no less than 40 of the servo's period, because a fast servo in one step
// would be quicker than it is.
[[nodiscard]] inline int servo_steps(const ServoLaw& law, double time) noexcept {
  return static_cast<int>(std::max(1.0, std::ceil(40.0 * law.frequency * time)));
}

[[nodiscard]] inline Vec3 clipped(const Vec3& v, double longest) noexcept {
  const double size = v.norm();
  return size > longest ? Vec3(v * (longest / size)) : v;
}

// Towards `wanted` for this time, s; semi-implicit, so that it stays stable.
inline void follow(const ServoLaw& law, const Vec3& wanted, double time, ServoMotion& motion) noexcept {
  const int steps = servo_steps(law, time);
  const double dt = time / steps;
  const double w = 2.0 * std::numbers::pi * law.frequency;
  const Vec3 before = motion.velocity;
  for (int i = 0; i < steps; ++i) {
    const Vec3 error = wanted - motion.p;
    const Vec3 pull = clipped(w * w * error - 2.0 * law.damping * w * motion.velocity, law.acceleration);
    motion.velocity = clipped(motion.velocity + dt * pull, law.speed);
    motion.p += dt * motion.velocity;
  }
  motion.acceleration = (motion.velocity - before) / time;
}

// The nearest of the steps that a machine can make, each so long, m; 0: every place.
[[nodiscard]] inline Vec3 in_steps(const Vec3& p, double step) noexcept {
  return step > 0.0 ? Vec3((p / step).array().round() * step) : p;
}

}  // namespace enc
