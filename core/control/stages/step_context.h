// Step context: the data that pass through the stages of a tick, and the functions that tasks share. Internal
// to the core: step.cpp calls the stages, and each task has its own (tasks.h).
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
  // Set by guide(): target of an arm that follows no finger; unset: it waits.
  Point<'W'> sent;
  const Pose<'W', 'H'>* carried = nullptr;  // Set by carry(): target of the machine with its tool.

  bool tool_known = false;  // track
  bool tool_fresh = false;
  Pose<'W', 'T'> X_WT;
  Pose<'W', 'T'> X_WT_newest;  // Newest measured pose without extrapolation, and the tip there.
  Point<'W'> tip_newest;
  Point<'W'> tool_tip;
  double tool_radius = 0.0;
  // track: the tip is firm, so a tool cannot pass through it.
  bool stops_tool = false;
  std::span<MoverState> moved;  // track: objects that move
  std::span<const Mover> movers;
  Pose<'W', 'H'> X_WH;  // track: tip pose reported by the machine

  // touch: nearest to the tool; without a tracker, to the tip.
  Point<'W'> surface_point;
  Vec<'W'> normal;      // outward
  double gap = kUnset;  // m
  // check_tip: nearest to the tip's centre, in the frame of state.object.
  SurfacePoint at_tip;
  Vec<'W'> force;                           // sense: force on the tip, N
  Vec<'W'> felt;                            // sense: that force before the low-pass, N
  Point<'W'> target;                        // target: wanted tip centre
  Mat3 jacobian = Mat3::Zero();             // track: of an arm
  Vec3 target_acceleration = Vec3::Zero();  // aim: acceleration of an arm's target on its path, m/s^2
  Vec3 target_change = Vec3::Zero();        // aim: that acceleration on and off its path, m/s^2
  Vec<'W'> tip_velocity;                    // track: velocity of an arm's tip
  Vec<'W'> wanted_force;                    // render_impedance(): force that the law asks for; unset: none
  double along_mass = 0.0;                  // kg, tip mass along the normal, with a passivity controller
  Vec<'R'> arm_force;                       // guard: commanded force of an arm
};

// Query for the surface nearest to a tool.
struct SurfaceQuery {
  const Contact* engaged = nullptr;  // if set, only the object of this contact
  bool touched_first = false;        // prefer any touched object to every untouched one
  // Predicted touch of the tool; unset: extrapolate its motion by follow.ahead.
  Point<'W'> comes_to{};
};
void nearest_surface(StepContext& context, CommonState& state, const SurfaceQuery& asked) noexcept;
// The tracked tool at this tick. `pressing`: a finger that rests on a prop moves slowly.
void track_tool(StepContext& context, CommonState& state, bool pressing) noexcept;

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
