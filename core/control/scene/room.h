// Whether an object has room for the tip: all of it shall be inside, and wait a little inside of the surface.
#pragma once

#include <cstddef>

#include "core/control/scene/scene.h"

namespace enc {

// How deep the tip's centre waits in follow, m.
[[nodiscard]] inline double room_margin(const Scene& scene) { return scene.tip_radius + scene.follow.inset; }

// What room an object has for a tip.
struct Room {
  double deepest = 0.0;   // m: how deep the deepest place is, where that is less than the margin
  Point<'O'> at;          // there
  double thin = 0.0;      // share of its surface under which the object is too thin
  Point<'O'> thin_at;     // where it is thinnest,
  double thinnest = 0.0;  // and how thin, m
};
// A plane has room. `thin`: also look where the object is too thin, at each triangle.
[[nodiscard]] Room room_in(const Object& object, double margin, bool thin);
// Whether it is thick enough under a place of its surface.
[[nodiscard]] bool room_under(const Object& object, double margin, const Point<'W'>& on,
                              const Vec<'W'>& normal);

// A part of prepare(): throws Error (key: that of the object's shape) where an object has no room for the tip
// and its inset, so that nothing could be touched.
void check_room(const SceneSpec& spec, const Scene& scene);

}  // namespace enc
