// The seen surface in a picture: a mesh, or a ball as a fine one, that the tool's tip dents [VHMR 3.5].
// Pictures only; it touches nothing and weighs nothing.
#pragma once

#include <string>

#include "core/control/scene/scene.h"
#include "core/spec/object_spec.h"
#include "sim/bodies/mujoco.h"

namespace enc::sim {

// What is seen of an object is a geom called seen_name(object). These are meshes, around the origin of O.
mjsGeom* add_seen_ball(mjSpec* spec, std::size_t object, double radius);
mjsGeom* add_seen_mesh(mjSpec* spec, std::size_t object, const Mesh& mesh, double scale);
[[nodiscard]] std::string seen_name(std::size_t object);
// Gives the object's geom, named already, the material that the object names or its mesh's file has. Without
// one it keeps its colour. A virtual object stays translucent, so that the machine inside of it is seen.
void set_material(mjSpec* spec, mjsGeom* geom, std::size_t object, const ObjectSpec& is, bool real);

// In the picture alone, until the physics steps again.
void shift_seen(const mjModel* model, mjData* data, std::size_t object, const Vec<'W'>& shift);

// Displaces vertices and normals of that mesh by a tip. Gives the index of the mesh; -1 where the object has
// none, or one that cannot be displaced. To be done once, before the model is given to a renderer.
int dent_seen(mjModel* m, const mjData* data, const Scene& scene, std::size_t object, const Tip<'W'>& tip);

}  // namespace enc::sim
