// Prepares a scene with an arm: the part of prepare() for machines that take a force and report a position.
#pragma once

#include "core/control/scene/scene.h"

namespace enc {

// Throws Error like prepare(): an object out of reach or near a singular pose, a gain that is negative or
// under-damped, a missing role.
[[nodiscard]] Scene prepare_arm(const SceneSpec& spec, const RigSpec& rig);

// Copies the parts that a scene of any machine takes unchanged from both files: frames, settings and the
// tracker's pose.
void keep_settings(const SceneSpec& spec, const RigSpec& rig, Scene& scene);

// Damping ratio of a tip of `mass` (kg) under f = K_p e + K_v de/dt.
[[nodiscard]] double damping_ratio(const ArmRig& rig, double mass);

}  // namespace enc
