// What walks through the stages of a tick, and what the tasks share. Internal to the core: step.cpp calls the
// stages, each task has its own (tasks.h).
#pragma once

#include <span>

#include "core/control/stages/common_state.h"
#include "core/control/stages/contact.h"
#include "core/control/world/common_scene.h"
#include "core/control/world/moving.h"
#include "core/devices/signals.h"

namespace enc::stages {

// What a tick knows so far. Each stage reads what the ones before it wrote.
struct Walk {
  Walk(const CommonScene& s, const Tick& k, const Inputs& i) : scene(s), tick(k), in(i) {}
  const CommonScene& scene;
  const Tick& tick;
  const Inputs& in;
  std::uint32_t why = 0;
  Point<'W'> sent;  // guide: where an arm goes while it follows nobody; unset: it waits
  const Pose<'W', 'H'>* carried = nullptr;  // carry: where the machine goes with its tool

  bool tool_known = false;  // track
  bool tool_fresh = false;
  Pose<'W', 'T'> X_WT;
  Pose<'W', 'T'> X_WT_newest;  // of the newest pose, not carried on; and the tip there
  Point<'W'> tip_newest;
  Point<'W'> tool_tip;
  double tool_radius = 0.0;
  bool stops_tool = false;  // track: the tip is firm, and a tool does not go through it
  std::span<Moved> moved;   // track: objects that move
  std::span<const Mover> movers;
  Pose<'W', 'H'> X_WH;  // track: where the machine says the tip is

  Point<'W'> surface_point;      // touch: nearest to the tool; without a tracker, to the tip
  Vec<'W'> normal;               // outward
  double gap = kUnset;           // m
  Nearest at_tip;                // check_tip: nearest to the tip's centre, in the frame of state.object
  Vec<'W'> force;                // sense: on the tip, N
  Vec<'W'> felt;                 // the same before the low-pass
  Point<'W'> target;             // target: wanted tip centre
  Mat3 jacobian = Mat3::Zero();  // track: of an arm; and
  Vec3 target_acceleration = Vec3::Zero();  // encounter: of its target, on its way
  Vec3 target_change = Vec3::Zero();        // and in any case, m/s^2
  Vec<'W'> tip_velocity;                    // of its tip
  Vec<'W'> wanted_force;                    // impede: what the law asks for; unset: nothing
  double along_mass = 0.0;                  // kg, of the tip along the normal, where energy is controlled
  Vec<'R'> arm_force;                       // guard: what an arm is told
};

// The surface nearest to a tool: what is asked of the objects, and of which one alone.
struct Asked {
  const Contact* engaged = nullptr;  // with this one
  bool touched_first = false;        // whatever is touched comes before what is not
  Point<'W'> comes_to{};  // where the tool will touch; unset: it goes on for follow.ahead as it goes now
};
void nearest_surface(Walk& walk, CommonState& state, const Asked& asked) noexcept;
// The tool as the tracker sees it, at this tick. `pressing`: a finger that rests on a prop moves slowly.
void track_tool(Walk& walk, CommonState& state, bool pressing) noexcept;

// Outward normal and distance of a W point to an object.
struct NearestInWorld {
  Point<'W'> point;
  Vec<'W'> normal;
  double distance = kUnset;
};
[[nodiscard]] NearestInWorld nearest(const Object& object, const Point<'W'>& p) noexcept;
// The same of the scene's object `index`, from where the last such query ended.
[[nodiscard]] NearestInWorld nearest(const CommonScene& scene, std::int32_t index, const Point<'W'>& p,
                                     ObjectHint& hint) noexcept;

// Of the machine's acceleration, the way along the normal has 0.8 and the sideways way 0.6 for sure (together
// 1), so that neither starves.
inline constexpr double kAlongShare = 0.8;
inline constexpr double kSideShare = 0.6;
// The tip stops this far inside the surface at zero deflection: more than the machine's own step, less than
// anybody feels.
inline constexpr double kSkin = 5e-6;  // m
[[nodiscard]] inline bool holding(const Walk& walk) { return (walk.why & kHoldReasons) != 0; }

}  // namespace enc::stages
