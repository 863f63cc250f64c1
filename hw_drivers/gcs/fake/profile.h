// The path of a platform to its commanded position: all six coordinates start and end together, within
// velocity and acceleration limits. A new command during motion bends the path.
#pragma once

#include "hw_drivers/gcs/wire/coordinates.h"

namespace enc::gcs {

struct ProfileLimits {
  double velocity = 0.0, acceleration = 0.0;  // m/s, m/s^2; a degree counts as a millimetre
};

class Profile {
 public:
  void reset(const Coordinates& at) noexcept;  // it stands there
  void go(const Coordinates& to) noexcept;
  // Brakes on its path, `hardness` times as hard as its acceleration limit, and stays where that ends.
  void halt(double hardness) noexcept;
  void step(double dt, const ProfileLimits& limits) noexcept;

  [[nodiscard]] const Coordinates& at() const noexcept { return at_; }
  [[nodiscard]] const Coordinates& aim() const noexcept { return to_; }
  [[nodiscard]] bool moving() const noexcept { return moving_; }

 private:
  Coordinates at_{}, to_{}, velocity_{};
  double hardness_ = 0.0;  // deceleration factor; 0: moving
  bool moving_ = false;
};

}  // namespace enc::gcs
