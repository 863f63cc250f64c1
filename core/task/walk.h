// The stages of a tick, in the order in which data walk through them. Internal to the core: step.cpp calls,
// one file each defines.
#pragma once

#include "core/step.h"

namespace enc::stages {

// What a tick knows so far. Each stage reads what the ones before it wrote.
struct Walk {
  Walk(const Scene& s, const Tick& k, const Inputs& i) : scene(s), tick(k), in(i) {}
  const Scene& scene;
  const Tick& tick;
  const Inputs& in;
  std::uint32_t why = 0;
  Point<'W'> sent;  // guide: where an arm goes while it follows nobody; unset: it waits

  bool tool_known = false;  // track
  bool tool_fresh = false;
  Pose<'W', 'T'> X_WT;
  Pose<'W', 'T'> X_WT_newest;  // of the newest pose, not carried on; and the tip there
  Point<'W'> tip_newest;
  Point<'W'> tool_tip;
  double tool_radius = 0.0;
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
  Vec<'R'> arm_force;                       // impede: what an arm is told
};

void track(Walk& walk, State& state) noexcept;
void grip(Walk& walk) noexcept;
void touch(Walk& walk, State& state) noexcept;
void sense(Walk& walk, State& state) noexcept;
void mode(Walk& walk, State& state) noexcept;
void model(Walk& walk, State& state) noexcept;
void target(Walk& walk, State& state) noexcept;
// In place of the three above: where the machine presses a real object, and where it carries a tool around.
void probe(Walk& walk, State& state) noexcept;
void travel(Walk& walk, State& state) noexcept;
// And of an arm, which takes a force: where its prop shall be, and with which force it is sent there.
void push(Walk& walk, State& state) noexcept;
void encounter(Walk& walk, State& state) noexcept;
void impede(Walk& walk, State& state) noexcept;
// Inside the object, inside the seen surface, finite, reachable, slow enough. Writes the set-point into
// state.command.
void check_tip(Walk& walk, State& state) noexcept;
void limit_command(Walk& walk, State& state) noexcept;

// Outward normal and distance of a W point to an object.
struct NearestInWorld {
  Point<'W'> point;
  Vec<'W'> normal;
  double distance = kUnset;
};
[[nodiscard]] NearestInWorld nearest(const Object& object, const Point<'W'>& p) noexcept;
// The same of the scene's object `index`, from where the last such query ended.
[[nodiscard]] NearestInWorld nearest(const Scene& scene, std::int32_t index, const Point<'W'>& p,
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
