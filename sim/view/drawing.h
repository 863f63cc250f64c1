// Puts a ViewRequest into MuJoCo's scene. Pictures in files and the window share these functions.
#pragma once

#include "sim/bodies/mujoco.h"
#include "sim/view/view.h"

namespace enc::sim {

inline constexpr int kRoom = 1000;  // geoms
// m, distance of the white backdrop; translucent geoms need something to mix with.
inline constexpr double kBackdrop = 4.0;

// A copy of the model with settings for pictures; the physics never sees it. `shadow_size`: size of the
// shadow map, px. `stacks`, `slices`: parts of a round body, along its axis and around it.
[[nodiscard]] ModelPtr picture_model(const ViewRequest& request, int shadow_size, int stacks, int slices);
// Adds the model's bodies, camera and light. Throws Error (kind device) for too many geoms, as the functions
// below do.
void aim(mjvScene& scene, const mjModel* model, const ViewRequest& request, bool shadows);
// Adds a wall that fills the background.
void add_backdrop(mjvScene& scene);
// Adds rods, boxes, arrows, signs and the floor.
void add_extras(mjvScene& scene, const ViewRequest& request);

}  // namespace enc::sim
