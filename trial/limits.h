// What a machine can do at the objects of a scene, against what the scene asks of it: known before anything
// moves. In simulation it is said and runs; a real machine that is armed refuses it (sources/choices 15).
#pragma once

#include <string>
#include <vector>

#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

// Where an object is touched: where the user presses it, or nearest to home. Of an arm: its joints there and
// the outward normal in R.
struct TouchedPlace {
  PressPoint at;
  PerJoint joints{};
  Vec<'R'> way;
  bool pressed = false;  // the user's plan says so
};
[[nodiscard]] TouchedPlace touched_place(const models::Setup& setup, const Scene& scene, std::size_t object);
// N/m: the most that an object asks of an arm.
[[nodiscard]] double stiffest_asked(const Impedance& law, const Object& object);

// What an arm can do at an object, where the user presses it or nearest to home, and what the scene asks of
// it.
struct ArmStrength {
  std::string object;
  double peak = 0.0, lasting = 0.0;  // N, along the normal: for a moment and for hours, as the rig believes
  double asked = kUnset;             // N, of the user's press; unset: nobody presses it to a depth
  double asked_for = 0.0;            // s
  double holds_for = 0.0;            // s, of that force, until cold motors give less; infinite: for hours
  std::int64_t presses = 1;          // of the user
  std::int64_t gives_way_in = 0;     // the press in which warm motors give less; 0: none
};
// What of it is beyond a limit; empty: nothing.
[[nodiscard]] std::string beyond_text(const ArmStrength& at);

// Of each object; of a machine that is no arm: none.
[[nodiscard]] std::vector<ArmStrength> strengths_of(const models::Setup& setup, const Scene& scene);

}  // namespace enc::trial
