// The background of a stage as a MuJoCo model in the axes of C, and the geoms that a hand is copied from. All
// of it is farther than 1 m from the camera, so that a hand is in front of it.
#pragma once

#include "sim/bodies/mujoco.h"
#include "sim/camera/stage.h"

namespace enc::sim {

inline constexpr const char* kSkinGeom = "skin";
inline constexpr const char* kSleeveGeom = "sleeve";
inline constexpr const char* kTubeGeom = "tube";  // skin of a tube

[[nodiscard]] ModelPtr scenery_model(const StageSpec& spec);

}  // namespace enc::sim
