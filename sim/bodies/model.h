// The MuJoCo model of a scene, assembled with mjSpec from the parts that the scene names.
#pragma once

#include <string>

#include "core/control/scene/scene.h"
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

}  // namespace enc::sim
