// The path of the fake's platform: the controller's own, or by points of the client.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "hw_drivers/gcs/wire/coordinates.h"

namespace enc::gcs {

// The path of a platform to its commanded position. All six coordinates start and end together, within
// velocity and acceleration limits. A new command during motion bends the path.
struct ProfileLimits {
  double velocity = 0.0, acceleration = 0.0;  // m/s, m/s^2; a degree counts as a millimetre
};

class Profile {
 public:
  void reset(const Coordinates& at) noexcept;  // sets it to rest there
  void go(const Coordinates& to) noexcept;
  // Brakes on its path, `hardness` times as hard as its acceleration limit, and stays where it stops.
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

// A path of points, one for each cycle (parameter 0x19001900 = 1, SCT). The platform moves straight from one
// point to the next, in one cycle or at the speed limit. Without a further point it stands at the last one.
class Points {
 public:
  static constexpr std::size_t kMost = 64;

  [[nodiscard]] std::size_t free() const noexcept { return kMost - count_; }
  [[nodiscard]] bool going() const noexcept { return going_ || count_ > 0; }
  void add(const Coordinates& point) noexcept {
    if (free() > 0) line_[(first_ + count_++) % kMost] = point;
  }
  // The last point added; if no point is pending, the present target or position.
  [[nodiscard]] const Coordinates& last(const Coordinates& at) const noexcept {
    return count_ > 0 ? line_[(first_ + count_ - 1) % kMost] : going_ ? to_ : at;
  }
  void clear() noexcept {
    count_ = 0;
    going_ = false;
  }
  // Position after dt from `at`; s, m/s.
  [[nodiscard]] Coordinates step(Coordinates at, double dt, double cycle, double fastest) noexcept {
    for (double left = dt; left > 1e-9;) {
      if (!going_) {
        if (count_ == 0) return at;
        to_ = line_[first_];
        first_ = (first_ + 1) % kMost;
        --count_;
        going_ = true;
        due_ = std::max(cycle, distance(at, to_) / fastest);
      }
      const double span = due_ < left ? due_ : left;
      for (std::size_t i = 0; i < kAxes; ++i) at[i] += (to_[i] - at[i]) * (span / due_);
      due_ -= span;
      left -= span;
      if (due_ > 1e-9) continue;
      at = to_;
      going_ = false;
    }
    return at;
  }

 private:
  std::array<Coordinates, kMost> line_{};
  std::size_t first_ = 0, count_ = 0;
  Coordinates to_{};
  double due_ = 0.0;  // s until it reaches to_
  bool going_ = false;
};

}  // namespace enc::gcs
