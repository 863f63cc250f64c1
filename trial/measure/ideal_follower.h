// The best that a machine of given speed and acceleration can do to stay under a hand. It receives the
// surface point under the tool late, either held or extrapolated at constant velocity. It moves straight
// there, at a speed from which it can still stop. Its lag is the miss that rig and hand allow
// (docs/notes/encounter.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/frames.h"
#include "core/control/safety/inside.h"

namespace enc::trial {

class IdealFollower {
 public:
  enum class Sees : std::uint8_t { held, carried_on };

  // `age`: s, age of the seen point; speed and acceleration: m/s and m/s^2; dt: s, a tick.
  IdealFollower(Sees sees, double age, double speed, double acceleration, double dt)
      : sees_(sees),
        age_(age),
        late_(static_cast<std::size_t>(std::max(1.0, std::ceil(age / dt))), Vec3::Constant(kUnset)),
        speed_(speed),
        acceleration_(acceleration),
        dt_(dt) {}

  // One tick: position of the followed point, m. The follower starts there, at rest.
  void see(const Vec3& point) {
    Vec3& oldest = late_[next_];
    next_ = (next_ + 1) % late_.size();
    const Vec3 then = oldest;
    oldest = point;
    const Vec3& after = late_[next_];
    const Vec3 seen = sees_ == Sees::held ? then : Vec3(then + (after - then) * (age_ / dt_));
    if (!at_.allFinite()) at_ = point;
    if (!seen.allFinite()) return;
    const Vec3 way = seen - at_;
    const double distance = way.norm();
    const double fastest = std::min(speed_, approach_speed(distance, acceleration_, dt_));
    const Vec3 wanted = distance > 0.0 ? Vec3(way * (fastest / distance)) : Vec3(Vec3::Zero());
    const Vec3 change = wanted - velocity_;
    const double most = acceleration_ * dt_;
    velocity_ += change.norm() > most ? Vec3(change * (most / change.norm())) : change;
    at_ += velocity_ * dt_;
  }

  // Distance of `point` from the follower, m.
  [[nodiscard]] double behind(const Vec3& point) const {
    return at_.allFinite() ? (point - at_).norm() : 0.0;
  }

 private:
  Sees sees_;
  double age_;
  std::vector<Vec3> late_;  // a ring, the oldest at next_
  std::size_t next_ = 0;
  double speed_, acceleration_, dt_;
  Vec3 at_ = Vec3::Constant(kUnset), velocity_ = Vec3::Zero();
};

}  // namespace enc::trial
