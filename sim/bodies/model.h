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
  const ToolSpec* tool = nullptr;     // held by the user; none: no tool body
  Quat q_WT = Quat::Identity();       // its orientation
  const ToolSpec* clamped = nullptr;  // by the gripper
  Pose<'H', 'T'> X_HT;                // and how it sits there
  Pose<'W', 'R'> X_WR;                // where the machine really stands
  std::string mjcf_dir;               // models/mjcf
  bool draw_all = false;              // also legs, objects and lights, for a picture
  const ToolSpec* other = nullptr;    // that the user changes to
  Vec3 finger{0, 0, 1};               // of a tool without markers: from its tip to the hand, unit
};

[[nodiscard]] SpecPtr build_model(const ModelParts& parts);

}  // namespace enc::sim
