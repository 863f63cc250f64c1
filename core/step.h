// The whole haptic core is one pure function: no I/O, no clock, no heap, no lock [architecture B4].
//   track -> touch -> sense -> mode -> model -> target -> guard
#pragma once

#include <type_traits>

#include "core/mode.h"
#include "core/predict.h"
#include "core/response.h"
#include "core/sample.h"
#include "core/scene.h"
#include "core/view.h"

namespace enc {

// The newest sample of each device that exists; the others stay absent.
struct Inputs {
  Stamped<TrackedTool> tool;
  Stamped<Wrench> wrench;
  Stamped<TipSample> tip;
  Stamped<DentSample> dent;
  Stamped<GripSample> grip;
  std::int64_t missed = 0;  // cycles the clock lost before this tick
};

struct Outputs {
  Pose<'R', 'H'> tip;  // set-point for the coming period
  Mode mode = Mode::away;
  std::uint32_t why = 0;      // bits of Why
  std::int32_t object = -1;   // nearest object, or the one in contact
  std::int32_t contacts = 0;  // contacts since the start
  double gap = kUnset;        // of the tracked tool's tip to the surface, m; negative inside
  Vec<'N'> force;             // on the tip, N, filtered; z along the outward normal
  Vec<'W'> felt;              // the same force before the low-pass, N
  double deflection = 0.0;    // along -z of N, m: wanted; of a probe: measured, negative before it touches
  Point<'W'> first_touch;     // buffered point of the current or last contact, tip centre
  View view;
  Grip grip;
};

// The anchor of a contact [VHMR 3.4]: surface frame and how the object answers from there.
struct Contact {
  std::int32_t object = -1;
  std::int32_t tool = -1;  // that began it; -1: none was known
  Pose<'W', 'N'> X_WN;     // at the first touch
  bool anchored = false;   // true once force was felt with the tip under the tool: the anchor no longer moves
  Time loaded{};           // last tick on which force was felt; the start of time: never
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
  Point<'R'> command;  // last set-point
  Vec<'R'> command_velocity = Vec<'R'>::zero();
  Point<'W'> last_query, last_point;  // of the last tick: the tracked tool's tip and the surface under it
  Hints hints;
};

void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept;

static_assert(std::is_trivially_copyable_v<Inputs> && std::is_trivially_copyable_v<Outputs> &&
              std::is_trivially_copyable_v<State>);

}  // namespace enc
