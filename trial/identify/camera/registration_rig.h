// What a guided registration works on: the arm, the camera, and the places that the tip goes to.
#pragma once

#include <cstddef>
#include <vector>

#include "models/setup/scene_file.h"
#include "trial/identify/camera/guided.h"

namespace enc::trial {

// What a registration works on: the arm as believed and as it is, and the camera where it really is.
struct RegistrationRig {
  ArmMachine believed;
  sim::ArmTruth arm;
  double least_dexterity = 0.15;
  Pose<'W', 'C'> X_WC;
  sim::CameraTruth camera;
};

// The places of the tip that a rig offers, and which of them are used and judged.
struct RegistrationPlaces {
  std::vector<Point<'W'>> visited;  // well spread, the most that are used
  std::vector<Point<'W'>> targets;  // all over the volume in view
  std::vector<double> distance;     // of each target from the middle of the volume, m
};
[[nodiscard]] RegistrationPlaces places_of(const RegistrationRig& rig, std::size_t most_pairs);

// Throws Error where the rig has no arm, or none that is simulated.
[[nodiscard]] RegistrationRig registration_rig(const models::Setup& setup);

}  // namespace enc::trial
