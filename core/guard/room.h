// Whether an object has room for the tip: all of it shall be inside, and wait a little inside of the surface.
#pragma once

#include <cstddef>

#include "core/scene.h"

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
// Looks at `samples` places at most, evenly over the triangles of a mesh; 0: at each. A plane has room.
[[nodiscard]] Room room_in(const Object& object, double margin, std::size_t samples);

// A part of prepare(): throws Error (key: that of the object's shape) where an object has no room for the tip
// and its inset, so that nothing could be touched.
void check_room(const SceneSpec& spec, const Scene& scene);

}  // namespace enc
