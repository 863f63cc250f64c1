// The whole haptic core is one pure function: no I/O, no clock, no heap, no lock [sources/choices 1].
//   track -> touch -> sense -> mode -> model -> target -> guard
#pragma once

#include <type_traits>

#include "core/response/response.h"
#include "core/safety/following.h"
#include "core/signals.h"
#include "core/task/meet/impedance.h"
#include "core/track/predict.h"
#include "core/world/scene.h"

namespace enc {

// The anchor of a contact [VHMR 3.4]: surface frame and how the object answers from there.
struct Contact {
  std::int32_t object = -1;
  std::int32_t tool = -1;  // that began it; -1: none was known
  Pose<'W', 'N'> X_WN;     // at the first touch
  bool anchored = false;   // true once force was felt with the tip under the tool: the anchor no longer moves
  Time loaded{};           // last tick on which force was felt; the start of time: never
  Time began{}, left{};    // when it began, and when the tip was sent back
  double clear = 0.0;      // s for which its tool has been seen to be clear of the object
  ResponseState response;
  Swing swing;
  Vec<'N'> displacement = Vec<'N'>::zero();
};

// Where the machine is in its programme of pushes (probe.h). Time stands still in a hold, and the programme
// with it.
enum class ProbePhase : std::uint8_t { wait, approach, rest, push, dwell, back, done };
struct Probing {
  ProbePhase phase = ProbePhase::wait;
  double elapsed = 0.0;     // s of this phase
  double deflection = 0.0;  // wanted, m; negative: above the surface
};

// Where the machine is in its travel (travel.h). Time stands still in a hold, here too.
enum class TravelPhase : std::uint8_t { wait, move, dwell, done };
struct Travelling {
  TravelPhase phase = TravelPhase::wait;
  double elapsed = 0.0;  // s of this phase
  std::int32_t leg = 0;  // of the programme
};

// What the control law of an arm remembers (impedance.h).
struct Reaching {
  Point<'W'> target;  // X_d: where the tip shall be
  Vec<'W'> velocity = Vec<'W'>::zero();
  Vec<'W'> error = Vec<'W'>::zero(), error_rate = Vec<'W'>::zero();  // low-passed [eq. 3]
  double gain = 1.0;                                                 // lambda_z
  double sunk = 0.0;       // m: how far the target is behind the surface, in a button
  bool caught_up = false;  // the target is where the finger's projection is
  bool triggered = false;
  double blind = 0.0;  // s since the machine last said where it is
  Straying straying;   // from the target, where nothing but the arm itself can be why
  bool stuck = false;  // and it was for too long: until the finger has gone
};

// How far an object that moves has got, and what its finger does (moving.h).
struct Moved {
  Vec<'W'> shift = Vec<'W'>::zero(), velocity = Vec<'W'>::zero();
  double depth = kUnset;  // of the finger in it, m, at the last tick; unset: another object was nearest
  double deepest = 0.0;   // that of this touch, m; 0: they are apart
  double firmness = 1.0;  // share of its stiffness that is felt now
};

// Which part of which object was nearest: makes the next search faster, and changes no result (surface.h).
struct ObjectHint {
  std::int32_t object = -1, feature = -1;
};
struct Hints {
  std::array<ObjectHint, 2> tool;  // nearest to the tool, and the runner-up
  ObjectHint tip;                  // nearest to the tip, and
  ObjectHint command;              // to where it is sent
};

// All the memory that the core has.
struct State {
  bool started = false;
  Mode mode = Mode::away;  // the mode under a hold
  bool held = false;       // the last tick was one
  std::int32_t contacts = 0;
  std::int32_t object = -1;
  bool entered = false;       // the tip has been inside that object
  bool outside_dent = false;  // and is outside its deformed surface
  Stamped<TrackedTool> tool;
  TipMotion tip_motion;  // of the tracked tool
  Stamped<DentSample> dent;
  Vec<'F'> force_zero = Vec<'F'>::zero();
  double tared = 0.0;             // s of signal in force_zero
  Vec<'F'> tare_mean, tare_last;  // Tare::window: of the present window so far, and of the one before
  double tare_window = 0.0;       // s of signal in tare_mean
  Vec<'W'> force = Vec<'W'>::zero();
  Contact contact;
  Probing probing;
  Travelling travelling;
  Reaching reaching;
  Heat heat;  // of an arm's motors, as it is believed
  std::array<Moved, kMostMoving> moved;
  Point<'R'> command;  // last set-point
  Vec<'R'> command_velocity = Vec<'R'>::zero();
  Following following;
  Point<'W'> last_query, last_point;  // of the last tick: the tracked tool's tip and the surface under it
  Hints hints;
};

void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept;

static_assert(std::is_trivially_copyable_v<Inputs> && std::is_trivially_copyable_v<Outputs> &&
              std::is_trivially_copyable_v<State>);

}  // namespace enc
