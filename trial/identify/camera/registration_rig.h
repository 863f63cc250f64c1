// The inputs of a guided registration: the arm, the camera, and the positions of the tip.
#pragma once

#include <cstddef>
#include <vector>

#include "models/setup/scene_file.h"
#include "trial/identify/camera/guided.h"

namespace enc::trial {

// The rig of a registration: the arm's model and the true arm, and the true pose of the camera.
struct RegistrationRig {
  ArmMachine believed;
  sim::ArmTruth arm;
  double least_dexterity = 0.15;
  Pose<'W', 'C'> X_WC;
  sim::CameraTruth camera;
};

// The positions of the tip that a rig offers, and those used and judged.
struct RegistrationPlaces {
  std::vector<Point<'W'>> visited;  // well spread, the most that are used
  std::vector<Point<'W'>> targets;  // spread over the volume in view
  std::vector<double> distance;     // distance of each target from the middle of the volume, m
};
[[nodiscard]] RegistrationPlaces places_of(const RegistrationRig& rig, std::size_t most_pairs);

// Throws Error if the rig has no arm, or no simulated arm.
[[nodiscard]] RegistrationRig registration_rig(const models::Setup& setup);

}  // namespace enc::trial
