// A scene made ready: constant while the loop runs. What mjModel is to mjSpec, Scene is to SceneSpec and
// RigSpec.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/rotation.h"
#include "core/control/task/tasks.h"
#include "core/control/world/common_scene.h"
#include "core/machine/loop_model.h"
#include "core/machine/reach.h"
#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"

namespace enc {

struct Scene : CommonScene {
  // Made, copied and destroyed in scene.cpp: inline, every other file would compile that anew.
  Scene();
  ~Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;

  Tasks::Any task;  // what is done

  // The task, where it is this one; else null. An arm's law is that of Meet and of Push.
  [[nodiscard]] const Render* render() const { return std::get_if<Render>(&task); }
  [[nodiscard]] const Probe* probe() const { return std::get_if<Probe>(&task); }
  [[nodiscard]] const Travel* travel() const { return std::get_if<Travel>(&task); }
  [[nodiscard]] const Impedance* impedance() const {
    if (const auto* push = std::get_if<Push>(&task)) return push;
    return std::get_if<Meet>(&task);
  }
};

// Throws Error (key = the file key without its unit) where the scene cannot be rendered by this rig: an
// object or a press out of reach, a response that is not monotone or too soft, a role that is missing.
[[nodiscard]] Scene prepare(const SceneSpec& spec, const RigSpec& rig);

[[nodiscard]] Tool made_tool(const ToolSpec& spec);

// The loop of hand, filter, machine and dead time that a rig file promises (loop_model.h).
[[nodiscard]] LoopModel loop_of(const RigSpec& rig);

// The reach that a rig file promises. A device that can do less is refused before anything moves.
[[nodiscard]] Reach reach_of(const RigSpec& rig);
template <char A, char B>
[[nodiscard]] Pose<A, B> pose_of(const PoseSpec& spec) {
  return {rotation_xyz(spec.rotation), spec.position};
}

// Which tool the gripper of the scene clamps; nothing without a gripper.
[[nodiscard]] const ToolSpec* clamped_tool(const SceneSpec& spec);

// Largest residual of the chains of the frame graph [VHMR Fig 4], m (N, rad): where the stages of a tick say
// that tool, tip, force and objects are, against where plain matrices of the same specs put them
// (chains.cpp).
[[nodiscard]] double chain_residual(const SceneSpec& spec, const RigSpec& rig, const Scene& scene);
// Where the user of the scene presses: the surface point and its outward normal, in W.
struct PressPoint {
  Point<'W'> point;
  Vec<'W'> normal;
};
[[nodiscard]] PressPoint press_point(const SceneSpec& spec, const UserSpec& user);
// Where the pusher of the scene pushes, and where that shall end: at its depth or its force, whichever comes
// first.
struct PushedPoint {
  PressPoint at;
  double depth = kUnset, force = kUnset;  // m, N: on the object's curve
};
[[nodiscard]] PushedPoint pushed_point(const SceneSpec& spec, const Scene& scene);

}  // namespace enc
