// Checks of a press: whether the machine gets there, its mount is out of the way, and the object has room for
// the tip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/control/scene/scene.h"

namespace enc {

// Checks whether a surface point can be pressed: the machine must be able to place its tip there, and the
// tip's mount must not block the tool. That is why a ball cannot be pressed from below [VHMR 5].

// True if the tip's centre can go `depth` below the surface point, less the tip's own radius; straight axes.
[[nodiscard]] bool carried_to(const Scene& scene, const PressPoint& press, double depth);

enum class Obstacle : std::uint8_t { none, stem, gripper, platform };
[[nodiscard]] std::string_view obstacle_name(Obstacle obstacle);

// The part of the machine's mount that blocks a tool, if any. The tool stands on the haptic-tip along
// `normal`; from the tip's centre to its markers it is as thick as its tip.
[[nodiscard]] Obstacle in_the_way(const Scene& scene, const Vec<'W'>& normal, const Tool& tool);
// Largest angle between the normal and straight up at which the mount does not block the tool, rad.
[[nodiscard]] double steepest_press(const Scene& scene, const Tool& tool);

// Depth of the tip's centre in follow mode, m.
[[nodiscard]] inline double room_margin(const Scene& scene) { return scene.tip_radius + scene.follow.inset; }

// The room that an object has for a tip: in follow mode the whole tip must fit inside, a little below the
// surface.
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
