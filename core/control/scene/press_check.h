// Whether a point of a surface can be pressed: the machine must carry its tip there, and what carries the tip
// must not be in the tool's way. That is why a ball cannot be pressed from below [VHMR 5].
#pragma once

#include <cstdint>
#include <string_view>

#include "core/control/scene/scene.h"

namespace enc {

// The tip's centre can be `depth` below the surface point, less the tip's own radius; straight axes.
[[nodiscard]] bool carried_to(const Scene& scene, const PressPoint& press, double depth);

enum class Obstacle : std::uint8_t { none, stem, gripper, platform };
[[nodiscard]] std::string_view obstacle_name(Obstacle obstacle);

// A tool stands on the haptic-tip along `normal`, from the tip's centre to its markers as thick as its tip:
// what of the machine's mount does it cut?
[[nodiscard]] Obstacle in_the_way(const Scene& scene, const Vec<'W'>& normal, const Tool& tool);
// Largest angle between the normal and straight up with nothing in the way, rad.
[[nodiscard]] double steepest_press(const Scene& scene, const Tool& tool);

}  // namespace enc
