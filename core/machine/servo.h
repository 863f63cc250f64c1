// The position servo of a machine: second order, within the machine's speed and acceleration. The twin uses
// it; a driver whose machine reports only its position assumes it.
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

// Model of a position-controlled machine's response, by the rig file.
struct ServoModel {
  double frequency = kUnset;  // natural, rad/s
  double damping = kUnset;    // ratio
  double delay = 0.0;         // s
  double dt = kUnset;         // s, period of the loop
  // s, at constant speed. The model assumes at most 0.1 s, whatever the rig file says.
  double lag = std::min(0.1, 2.0 * damping / frequency + delay);
  // Coefficients of a tick, implicit in the speed, so that no frequency and no dt make the model diverge.
  double turn = frequency * dt;                                    // rad
  double pull = frequency * turn;                                  // 1/s, towards the command
  double left = 1.0 / (1.0 + 2.0 * damping * turn + turn * turn);  // factor on the speed
};

// Motion of one point, in the axes of the caller: m, m/s, m/s^2.
struct ServoMotion {
  Vec3 p{0, 0, 0}, velocity{0, 0, 0}, acceleration{0, 0, 0};
};

// Number of steps for a time: at least 40 for each servo period, because a single step would make a fast
// servo too fast.
[[nodiscard]] inline int servo_steps(const ServoLaw& law, double time) noexcept {
  return static_cast<int>(std::max(1.0, std::ceil(40.0 * law.frequency * time)));
}

[[nodiscard]] inline Vec3 clipped(const Vec3& v, double longest) noexcept {
  const double size = v.norm();
  return size > longest ? Vec3(v * (longest / size)) : v;
}

// Moves towards `wanted` for this time, s; semi-implicit, so that it stays stable.
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

// The nearest position on the machine's grid of steps (m); 0: no grid.
[[nodiscard]] inline Vec3 in_steps(const Vec3& p, double step) noexcept {
  return step > 0.0 ? Vec3((p / step).array().round() * step) : p;
}

}  // namespace enc
