// Limits of a tip's motion: speeds from which it stops in time, and places with the whole tip inside an
// object.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/frames.h"
#include "core/control/world/common_scene.h"
#include "core/control/world/object.h"

namespace enc {

// Largest speed from which a machine still stops within `distance` (m), in steps of dt.
[[nodiscard]] inline double braking_speed(double distance, double acceleration, double dt) {
  const double unit = acceleration * dt;
  return unit * (std::sqrt(0.25 + 2.0 * distance / (unit * dt)) - 0.5);
}

// Largest speed towards something `distance` (m) away from which a machine can still stop in front of it.
[[nodiscard]] inline double approach_speed(double distance, double acceleration, double dt) {
  return std::min(0.5 * distance / dt, braking_speed(distance, acceleration, dt));
}

// Straight displacement to standstill: one more tick at `velocity`, then braking.
[[nodiscard]] inline Vec3 braking_way(const Vec3& velocity, double acceleration, double dt) {
  return dt * velocity + velocity * (velocity.norm() / (2.0 * acceleration));
}

// The velocity with its magnitude reduced by `less`, not below zero.
[[nodiscard]] inline Vec3 slowed(const Vec3& velocity, double less) {
  const double size = velocity.norm();
  return size > less ? Vec3(velocity * (1.0 - less / size)) : Vec3(Vec3::Zero());
}

}  // namespace enc

namespace enc::stages {

// Something that moves and brakes in straight lines, in W.
struct Brake {
  Point<'W'> at;                           // current position
  Vec3 velocity{0, 0, 0};                  // m/s
  double acceleration = 0.0, speed = 0.0;  // its limits, m/s^2 and m/s
  double dt = 0.0;                         // s
};

// The set of tip positions with the whole tip inside an object: its centre is `margin` deep or deeper, from
// every side. On a ball or a plane that is one wall; beside an edge or in a corner it is several, and the
// nearest one changes with the path. Internal to the core.
class Inside {
 public:
  // `shift`: displacement of an object that moves. `hint` as in surface.h; this class keeps it up to date.
  Inside(const CommonScene& scene, std::int32_t object, double margin, const Vec<'W'>& shift,
         ObjectHint& hint);
  Inside(const Object& object, double margin, const Vec<'W'>& shift, ObjectHint& hint);

  // m; negative: p is outside
  [[nodiscard]] double depth(const Point<'W'>& p) noexcept { return -at(local(p)).distance; }
  // The position nearest to `wanted` that is deep enough; exact if the object is convex there. If the object
  // is too thin for such a position, the deepest one found.
  [[nodiscard]] Point<'W'> nearest_to(const Point<'W'>& wanted) noexcept;
  // Velocity of the next tick: `wanted`, or the closest that the acceleration allows and that leaves a
  // straight path to stop inside. `here`: the current depth.
  [[nodiscard]] Vec3 velocity(const Brake& brake, double here, const Vec3& wanted) noexcept;
  // True if something that moves at v for this tick can stop inside.
  [[nodiscard]] bool can_stop(const Brake& brake, double here, const Vec3& v) noexcept {
    SurfacePoint met;
    return stops_inside(brake, here, v, met);
  }

 private:
  [[nodiscard]] Point<'O'> local(const Point<'W'>& p) const { return object_.X_OW * (p - shift_); }
  [[nodiscard]] SurfacePoint at(const Point<'O'>& p) noexcept;
  [[nodiscard]] double stop_depth(double here) const;
  [[nodiscard]] bool stops_inside(const Brake& brake, double depth, const Vec3& v,
                                  SurfacePoint& met) noexcept;

  const Object& object_;
  double margin_;
  Vec<'W'> shift_;
  ObjectHint& hint_;
};

}  // namespace enc::stages
