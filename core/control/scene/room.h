// Checks whether an object has room for the tip: in follow mode the whole tip must fit inside, a little below
// the surface.
#pragma once

#include <cstddef>

#include "core/control/scene/scene.h"

namespace enc {

// Depth of the tip's centre in follow mode, m.
[[nodiscard]] inline double room_margin(const Scene& scene) { return scene.tip_radius + scene.follow.inset; }

// The room that an object has for a tip.
struct Room {
  // m: depth of the deepest place, if less than the margin.
  double deepest = 0.0;
  Point<'O'> at;          // the deepest place
  double thin = 0.0;      // share of the surface with too thin an object below
  Point<'O'> thin_at;     // the thinnest place
  double thinnest = 0.0;  // m: thickness at thin_at
};
// A plane always has room. `thin`: also look for thin places, at each triangle.
[[nodiscard]] Room room_in(const Object& object, double margin, bool thin);
// True if the object is thick enough below a place on its surface.
[[nodiscard]] bool room_under(const Object& object, double margin, const Point<'W'>& on,
                              const Vec<'W'>& normal);

// A part of prepare(). Throws Error (key: that of the object's shape) if an object has no room for the tip
// and its inset, because a user could then touch nothing.
void check_room(const SceneSpec& spec, const Scene& scene);

}  // namespace enc
