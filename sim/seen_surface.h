// The seen surface in a picture: a mesh, or a ball as a fine one, that the tool's tip dents [VHMR 3.5].
// Pictures only; it touches nothing and weighs nothing.
#pragma once

#include <string>

#include "core/scene.h"
#include "sim/mujoco.h"

namespace enc::sim {

// Adds a mesh geom called seen_name(object), around the origin of O.
mjsGeom* add_seen_ball(mjSpec* spec, std::size_t object, double radius);
mjsGeom* add_seen_mesh(mjSpec* spec, std::size_t object, const Mesh& mesh, double scale);
[[nodiscard]] std::string seen_name(std::size_t object);

// Displaces vertices and normals of that mesh by a tip. Does nothing where the object has no such mesh. To be
// done once, and before the model is given to a renderer.
void dent_seen(Physics& physics, const Scene& scene, std::size_t object, const Tip<'W'>& tip);

}  // namespace enc::sim
