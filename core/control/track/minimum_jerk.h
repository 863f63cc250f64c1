// Minimum-jerk motion, as people move between two points: from 0 to 1 in unit time [Flash and Hogan 1985].
#pragma once

#include <algorithm>

namespace enc {

struct MinimumJerk {
  double x, v, a;  // position, velocity, acceleration
  constexpr explicit MinimumJerk(double s) {
    s = std::clamp(s, 0.0, 1.0);
    x = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
    v = 30.0 * s * s * (1.0 - s) * (1.0 - s);
    a = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
  }
};

}  // namespace enc
