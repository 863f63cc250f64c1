// Step context: the data that pass through the stages of a tick of every task, and the functions that tasks
// share. step.cpp calls the stages, and each task has its own (tasks.h), with a context of its own
// (Task::Context) if its stages pass on more.
#pragma once

#include <span>

#include "core/control/stages/common_state.h"
#include "core/control/world/common_scene.h"
#include "core/control/world/moving.h"
#include "core/devices/signals.h"

namespace enc::stages {

// Data of one tick so far. Each stage reads the results of the stages before it; a member's comment names the
// stage that writes it.
struct StepContext {
  StepContext(const CommonScene& s, const Tick& k, const Inputs& i) : scene(s), tick(k), in(i) {}
  const CommonScene& scene;
  const Tick& tick;
  const Inputs& in;
  std::uint32_t why = 0;

  bool tool_known = false;  // track
  bool tool_fresh = false;
  Pose<'W', 'T'> X_WT;
  Pose<'W', 'T'> X_WT_newest;  // Newest measured pose without extrapolation, and the tip there.
  Point<'W'> tip_newest;
  Point<'W'> tool_tip;
  double tool_radius = 0.0;
  Pose<'W', 'H'> X_WH;  // track: tip pose reported by the machine

  // touch: nearest to the tool; without a tracker, to the tip.
  Point<'W'> surface_point;
  Vec<'W'> normal;      // outward
  double gap = kUnset;  // m

  // sense, or an arm's guard: force on the tip before the low-pass, N
  Vec<'W'> force_unfiltered;
};

// Query for the surface nearest to a tool.
struct SurfaceQuery {
  const Contact* engaged = nullptr;  // if set, only the object of this contact
  bool touched_first = false;        // prefer any touched object to every untouched one
  // Predicted touch of the tool; unset: extrapolate its motion by follow.ahead.
  Point<'W'> comes_to{};
  std::span<const MoverState> moved{};  // positions of the objects that move
};
void nearest_surface(StepContext& context, CommonState& state, const SurfaceQuery& asked) noexcept;

struct ToolAtTip {
  bool pressing = false;  // a finger that rests on a prop moves slowly
  bool stopped = false;   // the tip is firm, so the tool cannot pass through it
};
// Computes the pose of the tracked tool at this tick.
void track_tool(StepContext& context, CommonState& state, const ToolAtTip& at_tip = {}) noexcept;

// Outward normal and distance of a W point to an object.
struct NearestInWorld {
  Point<'W'> point;
  Vec<'W'> normal;
  double distance = kUnset;
};
[[nodiscard]] NearestInWorld nearest(const Object& object, const Point<'W'>& p) noexcept;
// Nearest point of the scene's object `index`; the search starts where the last query ended.
[[nodiscard]] NearestInWorld nearest(const CommonScene& scene, std::int32_t index, const Point<'W'>& p,
                                     ObjectHint& hint) noexcept;

// The normal is guaranteed 0.8 and the sideways direction 0.6 of the machine's acceleration (together 1), so
// that neither starves.
inline constexpr double kAlongShare = 0.8;
inline constexpr double kSideShare = 0.6;
// Depth inside the surface at which the tip stops at zero deflection: more than the machine's own step, less
// than a person feels.
inline constexpr double kSkin = 5e-6;  // m
[[nodiscard]] inline bool holding(const StepContext& context) { return (context.why & kHoldReasons) != 0; }

}  // namespace enc::stages
