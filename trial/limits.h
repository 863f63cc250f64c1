// The abilities of a machine at a scene's objects, against the demands of the scene; known before anything
// moves. A simulation reports an excess and runs; an armed real machine refuses it (sources/choices 15).
#pragma once

#include <string>
#include <vector>

#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

// Law of an arm; only for the scene of an arm.
[[nodiscard]] inline const Impedance& impedance_of(const Scene& scene) { return *scene.impedance(); }

// Place at which an arm touches an object, the user's press or the point nearest to home, with the joints
// there and the outward normal in R.
struct TouchedPlace {
  PressPoint at;
  PerJoint joints{};
  Vec<'R'> way;
  bool pressed = false;  // the place is from the user's plan
};
[[nodiscard]] TouchedPlace touched_place(const models::Setup& setup, const Scene& scene, std::size_t object);
// N/m: highest stiffness that an object asks of an arm.
[[nodiscard]] double stiffest_asked(const Impedance& law, const Object& object);

// Strength of an arm at an object, at the user's press or nearest to home, and the scene's demand.
struct ArmStrength {
  std::string object;
  double peak = 0.0, lasting = 0.0;  // N, along the normal: brief and continuous, by the rig's model
  double asked = kUnset;             // N, user's press; unset: no press to a depth
  double asked_for = 0.0;            // s, requested duration
  double holds_for = 0.0;            // s, for that force, until cold motors give less; infinite: for hours
  std::int64_t presses = 1;          // number of the user's presses
  std::int64_t gives_way_in = 0;     // the press in which warm motors give less; 0: no press
};
// The part of the demand beyond a limit; empty: within limits.
[[nodiscard]] std::string beyond_text(const ArmStrength& at);

// One entry for each object; empty for a machine that is not an arm.
[[nodiscard]] std::vector<ArmStrength> strengths_of(const models::Setup& setup, const Scene& scene);
[[nodiscard]] std::vector<ArmStrength> arm_strengths(const models::Setup& setup, const Scene& scene);

}  // namespace enc::trial
