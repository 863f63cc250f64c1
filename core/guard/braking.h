// How fast something may be that has to stop in time.
#pragma once

#include <cmath>

namespace enc {

// Largest speed from which a machine still stops within `distance`, in steps of dt.
[[nodiscard]] inline double braking_speed(double distance, double acceleration, double dt) {
  const double unit = acceleration * dt;
  return unit * (std::sqrt(0.25 + 2.0 * distance / (unit * dt)) - 0.5);
}

}  // namespace enc
