// The acceleration of set-points: what the machine is told to do, as far as it can. GCS has no question for
// the machine's own.
#pragma once

#include "core/frames.h"

namespace enc::gcs {

class Acceleration {
 public:
  Acceleration(double period, double most) : period_(period), most_(most) {}  // s; m/s^2

  // Of the set-point that came a period after the last one.
  [[nodiscard]] Vec<'R'> next(const Vec3& point) noexcept {
    const Vec3 velocity = points_ > 0 ? Vec3((point - point_) / period_) : Vec3(0, 0, 0);
    Vec3 change = points_ > 1 ? Vec3((velocity - velocity_) / period_) : Vec3(0, 0, 0);
    if (change.norm() > most_) change *= most_ / change.norm();
    point_ = point;
    velocity_ = velocity;
    points_ = points_ < 2 ? points_ + 1 : 2;
    return Vec<'R'>(change);
  }
  void stand() noexcept { points_ = 0; }  // what comes next begins anew

 private:
  double period_, most_;
  Vec3 point_{0, 0, 0}, velocity_{0, 0, 0};
  int points_ = 0;
};

}  // namespace enc::gcs
