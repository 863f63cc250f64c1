// The MuJoCo model of a scene, assembled with mjSpec from the parts that the scene names, and the surfaces of
// its objects in a picture.
#pragma once

#include <string>

#include "core/control/scene/scene.h"
#include "core/spec/object_spec.h"
#include "sim/bodies/mujoco.h"
#include "sim/spec/twin_spec.h"

namespace enc::sim {

struct ModelParts {
  const SceneSpec& scene;
  const Scene& prepared;
  const TwinSpec& twin;
  const ToolSpec* tool = nullptr;     // held by the user; null: no tool body
  Quat q_WT = Quat::Identity();       // the tool's orientation
  const ToolSpec* clamped = nullptr;  // clamped by the gripper
  Pose<'H', 'T'> X_HT;                // pose of the clamped tool
  Pose<'W', 'R'> X_WR;                // true pose of the machine
  std::string mjcf_dir;               // models/mjcf
  bool draw_all = false;              // also legs, objects and lights, for a picture
  const ToolSpec* other = nullptr;    // tool that the user changes to
  Vec3 finger{0, 0, 1};               // unit, tool without markers: from its tip to the hand
};

[[nodiscard]] SpecPtr build_model(const ModelParts& parts);

// ---- the visible surface of an object in a picture: a mesh, or a ball as a fine mesh, that the tool's tip
// deforms [VHMR 3.5]. It exists only in pictures, without contact and mass.

// The visible geom of an object has the name seen_name(object). These are meshes around the origin of O.
mjsGeom* add_seen_ball(mjSpec* spec, std::size_t object, double radius);
mjsGeom* add_seen_mesh(mjSpec* spec, std::size_t object, const Mesh& mesh, double scale);
[[nodiscard]] std::string seen_name(std::size_t object);
// Sets the material of the object's geom, already named, to the object's or its mesh file's. Without a
// material the geom keeps its colour. A virtual object stays translucent, so that the machine inside it
// remains visible.
void set_material(mjSpec* spec, mjsGeom* geom, std::size_t object, const ObjectSpec& is, bool real);

// Only in the picture, until the physics steps again.
void shift_seen(const mjModel* model, mjData* data, std::size_t object, const Vec<'W'>& shift);

// Displaces vertices and normals of that mesh by a tip. Returns the index of the mesh, or -1 if the object
// has no mesh that can be displaced. Call it once, before a renderer gets the model.
int dent_seen(mjModel* m, const mjData* data, const Scene& scene, std::size_t object, const Tip<'W'>& tip);

}  // namespace enc::sim
