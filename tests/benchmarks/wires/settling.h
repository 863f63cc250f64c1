// How long a machine moves on after its last set-point: what is stated of a killed run, a cut cable and every
// other fault (docs/reference/safety.md).
#pragma once

#include <algorithm>
#include <limits>

#include "core/machine/servo.h"

namespace enc::bench::wires {

inline constexpr double kStands = 1e-4;  // m/s: a machine that is slower stands

// s until it stays slower than `stands` (m/s). At first it has this speed, and its last point is ahead, no
// farther than it needs to brake: set-points that a machine can follow leave no other. Infinite: after 5 s it
// still moves. Found by following the law for every such point: a servo whose acceleration is clipped passes
// its point, comes back too fast as well, and does so more than once.
[[nodiscard]] inline double longest_settling(const ServoLaw& law, double speed, double stands) noexcept {
  constexpr int kPoints = 100;
  constexpr double kStep = 1e-3;  // s
  constexpr int kSteps = 5000;
  const double brakes = 0.5 * speed * speed / law.acceleration;
  double longest = 0.0;
  for (int i = 0; i <= kPoints; ++i) {
    const Vec3 last(brakes * i / kPoints, 0.0, 0.0);
    ServoMotion motion;
    motion.velocity.x() = speed;
    double moved = 0.0;
    // Once slow, and so near that it can become no faster, it stays slow.
    for (int step = 1; step <= kSteps; ++step) {
      follow(law, last, kStep, motion);
      if (motion.velocity.norm() >= stands) moved = kStep * step;
      if (kStep * step - moved > 1.0 / law.frequency) break;
    }
    if (moved >= kStep * kSteps) return std::numeric_limits<double>::infinity();
    longest = std::max(longest, moved);
  }
  return longest;
}

}  // namespace enc::bench::wires
