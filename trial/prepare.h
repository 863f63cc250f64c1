// What step() needs of a set-up: all that a command asks for that moves nothing.
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"
#include "models/scene_file.h"

namespace enc::trial {

// prepare(), with the place in the file put before what is wrong.
[[nodiscard]] Scene prepare_setup(const models::Setup& setup);

// An object that would not stand still under the hand that the rig expects (core/steadiness.h).
struct Unsteady {
  std::string object;
  double depth = 0.0, swing = 0.0;  // m: pushed so deep it swings so far, peak to peak
};
[[nodiscard]] std::vector<Unsteady> unsteady_objects(const models::Setup& setup, const Scene& scene);
// One line each, without an end.
[[nodiscard]] std::string unsteady_text(const models::Setup& setup, const Unsteady& object);

// What an arm can do at an object, where the user presses it or nearest to home, and what the scene asks of
// it.
struct ArmStrength {
  std::string object;
  double peak = 0.0, lasting = 0.0;  // N, along the normal: for a moment and for ever, as the rig believes
  double stiffest = 0.0;             // N/m: stiffer the law rings (core/arm/impedance.h)
  double stiffness = kUnset;         // N/m, the most that the object asks for
  double asked = kUnset;             // N, of the user's press; unset: nobody presses it to a depth
  double asked_for = 0.0;            // s
  double holds_for = 0.0;            // s, of that force, until warm motors give less; infinite: for ever
};
[[nodiscard]] std::vector<ArmStrength> arm_strengths(const models::Setup& setup, const Scene& scene);
// What of it is beyond a limit; empty: nothing.
[[nodiscard]] std::string beyond_text(const ArmStrength& at);

}  // namespace enc::trial
