// Checks whether a surface point can be pressed: the machine must be able to place its tip there, and the
// tip's mount must not block the tool. That is why a ball cannot be pressed from below [VHMR 5].
#pragma once

#include <cstdint>
#include <string_view>

#include "core/control/scene/scene.h"

namespace enc {

// True if the tip's centre can go `depth` below the surface point, less the tip's own radius; straight axes.
[[nodiscard]] bool carried_to(const Scene& scene, const PressPoint& press, double depth);

enum class Obstacle : std::uint8_t { none, stem, gripper, platform };
[[nodiscard]] std::string_view obstacle_name(Obstacle obstacle);

// The part of the machine's mount that blocks a tool, if any. The tool stands on the haptic-tip along
// `normal`; from the tip's centre to its markers it is as thick as its tip.
[[nodiscard]] Obstacle in_the_way(const Scene& scene, const Vec<'W'>& normal, const Tool& tool);
// Largest angle between the normal and straight up at which the mount does not block the tool, rad.
[[nodiscard]] double steepest_press(const Scene& scene, const Tool& tool);

}  // namespace enc
