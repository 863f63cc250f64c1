// The way of a platform to where it is told to go: all six coordinates start and end together, no faster and
// no harder than allowed. A new aim while it moves bends the way.
#pragma once

#include "hw_drivers/gcs/wire/coordinates.h"

namespace enc::gcs {

struct ProfileLimits {
  double velocity = 0.0, acceleration = 0.0;  // m/s, m/s^2; a degree counts as a millimetre
};

class Profile {
 public:
  void reset(const Coordinates& at) noexcept;  // stands there
  void go(const Coordinates& to) noexcept;
  // Brakes on the way, this many times as hard as it may otherwise, and stays where that ends.
  void halt(double hardness) noexcept;
  void step(double dt, const ProfileLimits& limits) noexcept;

  [[nodiscard]] const Coordinates& at() const noexcept { return at_; }
  [[nodiscard]] const Coordinates& aim() const noexcept { return to_; }
  [[nodiscard]] bool moving() const noexcept { return moving_; }

 private:
  Coordinates at_{}, to_{}, velocity_{};
  double hardness_ = 0.0;  // of braking; 0: it goes
  bool moving_ = false;
};

}  // namespace enc::gcs
