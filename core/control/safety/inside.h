// Where the whole tip is inside of an object: its centre is `margin` deep or deeper, from whichever side. On
// a ball or a plane that is one wall; beside an edge or in a corner it is several, and which one is nearest
// changes with the way. Internal to the core.
#pragma once

#include "core/control/world/common_scene.h"
#include "core/control/world/object.h"

namespace enc::stages {

// Something that moves and brakes in straight lines, in W.
struct Brake {
  Point<'W'> at;                           // where it is
  Vec3 velocity{0, 0, 0};                  // m/s
  double acceleration = 0.0, speed = 0.0;  // what it has, m/s^2 and m/s
  double dt = 0.0;                         // s
};

class Inside {
 public:
  // `shift`: of an object that has moved. `hint` as in surface.h; it is kept up to date.
  Inside(const CommonScene& scene, std::int32_t object, double margin, const Vec<'W'>& shift,
         ObjectHint& hint);
  Inside(const Object& object, double margin, const Vec<'W'>& shift, ObjectHint& hint);

  // m; negative: p is outside.
  [[nodiscard]] double depth(const Point<'W'>& p) noexcept { return -at(local(p)).distance; }
  // The place nearest to `wanted` that is deep enough: exact where the object is convex around it. Where no
  // such place is found, as in what is too thin, the best so far.
  [[nodiscard]] Point<'W'> nearest_to(const Point<'W'>& wanted) noexcept;
  // The velocity of the next tick: `wanted`, or what the acceleration can make of it in a tick so that there
  // is always a way to stop inside, a straight one. `here`: the depth where it is now.
  [[nodiscard]] Vec3 velocity(const Brake& brake, double here, const Vec3& wanted) noexcept;
  // Whether who goes at v for this tick can stop inside.
  [[nodiscard]] bool can_stop(const Brake& brake, double here, const Vec3& v) noexcept {
    Nearest met;
    return stops_inside(brake, here, v, met);
  }

 private:
  [[nodiscard]] Point<'O'> local(const Point<'W'>& p) const { return object_.X_OW * (p - shift_); }
  [[nodiscard]] Nearest at(const Point<'O'>& p) noexcept;
  [[nodiscard]] double stop_depth(double here) const;
  [[nodiscard]] bool stops_inside(const Brake& brake, double depth, const Vec3& v, Nearest& met) noexcept;

  const Object& object_;
  double margin_;
  Vec<'W'> shift_;
  ObjectHint& hint_;
};

}  // namespace enc::stages
