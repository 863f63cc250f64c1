// What a machine can do at the objects of a scene, against what the scene asks of it: known before anything
// moves. In simulation it is said and runs; a real machine that is armed refuses it (sources/choices 15).
#pragma once

#include <string>
#include <vector>

#include "core/world/scene.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

// An object that would not stand still under the hand that the rig expects (core/machine/steadiness.h).
struct Unsteady {
  std::string object;
  double depth = 0.0, swing = 0.0;  // m: pushed so deep it swings so far, peak to peak
  double ramp = kUnset;             // s: and so quickly
};
// One line each, without an end.
[[nodiscard]] std::string unsteady_text(const models::Setup& setup, const Unsteady& object);

// What an arm can do at an object, where the user presses it or nearest to home, and what the scene asks of
// it.
struct ArmStrength {
  std::string object;
  double peak = 0.0, lasting = 0.0;  // N, along the normal: for a moment and for hours, as the rig believes
  double stiffest = 0.0;             // N/m: stiffer the law rings (core/task/meet/impedance.h)
  double stiffness = kUnset;         // N/m, the most that the object asks for
  double asked = kUnset;             // N, of the user's press; unset: nobody presses it to a depth
  double asked_for = 0.0;            // s
  double holds_for = 0.0;            // s, of that force, until cold motors give less; infinite: for hours
  std::int64_t presses = 1;          // of the user
  std::int64_t gives_way_in = 0;     // the press in which warm motors give less; 0: none
};
// What of it is beyond a limit; empty: nothing.
[[nodiscard]] std::string beyond_text(const ArmStrength& at);

struct Limits {
  std::vector<Unsteady> unsteady;      // of a machine that measures force: what it would not hold still
  std::vector<ArmStrength> strengths;  // of an arm: each object
};
[[nodiscard]] Limits limits_of(const models::Setup& setup, const Scene& scene);

}  // namespace enc::trial
