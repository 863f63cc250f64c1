// A prepared scene, constant while the loop runs. Scene is to SceneSpec and RigSpec as mjModel is to mjSpec.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/rotation.h"
#include "core/control/task/tasks.h"
#include "core/control/world/common_scene.h"
#include "core/machine/hexapod.h"
#include "core/machine/loop_model.h"
#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"

namespace enc {

struct Scene : CommonScene {
  // Defined in scene.cpp: inline, every including file would compile them anew.
  Scene();
  ~Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;

  Tasks::Any task;  // the task of this scene

  // The task if it has this type, else null. The law of an arm is that of ImpedanceTask or of
  // DynamicObjectTask.
  [[nodiscard]] const AdmittanceTask* admittance() const { return std::get_if<AdmittanceTask>(&task); }
  [[nodiscard]] const IndentationTask* indentation() const { return std::get_if<IndentationTask>(&task); }
  [[nodiscard]] const TrackingTask* tracking() const { return std::get_if<TrackingTask>(&task); }
  [[nodiscard]] const Impedance* impedance() const {
    if (const auto* push = std::get_if<DynamicObjectTask>(&task)) return push;
    return std::get_if<ImpedanceTask>(&task);
  }
};

// Throws Error (key = the file key without its unit) if this rig cannot render the scene: an object or a
// press out of reach, a response that is not monotone or too soft, a missing role.
[[nodiscard]] Scene prepare(const SceneSpec& spec, const RigSpec& rig);

// prepare() of machines that take a force and report a position. Throws Error: an object out of reach or near
// a singular pose, a gain that is negative or under-damped, a missing role.
[[nodiscard]] Scene prepare_arm(const SceneSpec& spec, const RigSpec& rig);

// Copies the parts that a scene of any machine takes unchanged from both files: frames, settings and the
// tracker's pose.
void keep_settings(const SceneSpec& spec, const RigSpec& rig, Scene& scene);

// Damping ratio of a tip of `mass` (kg) under f = K_p e + K_v de/dt.
[[nodiscard]] double damping_ratio(const ArmRig& rig, double mass);

[[nodiscard]] Tool made_tool(const ToolSpec& spec);

// The loop of hand, filter, machine and dead time, by the rig file (loop_model.h).
[[nodiscard]] LoopModel loop_of(const RigSpec& rig);

// The reach that the rig file states. The program refuses a device with less before anything moves.
[[nodiscard]] Reach reach_of(const RigSpec& rig);
template <char A, char B>
[[nodiscard]] Pose<A, B> pose_of(const PoseSpec& spec) {
  return {rotation_xyz(spec.rotation), spec.position};
}

// The tool that the scene's gripper clamps; null without a gripper.
[[nodiscard]] const ToolSpec* clamped_tool(const SceneSpec& spec);

// Largest residual of the chains of the frame graph [VHMR Fig 4], m (N, rad): tool, tip, force and objects
// from the stages of a tick, against plain matrices of the same specs.
[[nodiscard]] double chain_residual(const SceneSpec& spec, const RigSpec& rig, const Scene& scene);
// The surface point that the scene's user presses, with its outward normal, in W.
struct PressPoint {
  Point<'W'> point;
  Vec<'W'> normal;
};
[[nodiscard]] PressPoint press_point(const SceneSpec& spec, const UserSpec& user);
// The point that the scene's pusher pushes, and the end of the push: its depth or its force, whichever comes
// first.
struct PushedPoint {
  PressPoint at;
  double depth = kUnset, force = kUnset;  // m, N: by the object's curve
};
[[nodiscard]] PushedPoint pushed_point(const SceneSpec& spec, const Scene& scene);

}  // namespace enc
