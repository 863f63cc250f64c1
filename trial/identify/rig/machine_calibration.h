// `encounter calibrate rig RIG`: the machine carries a clamped tool through poses that tilt and rotate to all
// sides. The data of force sensor and tracker give the calibrated numbers of the rig.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/machine/reach.h"
#include "models/identify/rig/hand_eye.h"
#include "models/identify/rig/weight_fit.h"
#include "trial/identify/rig/carried_tool.h"

namespace enc::trial {

inline constexpr std::size_t kFewestPoses = 12, kUsualPoses = 24, kMostPoses = 500;

// Poses tilted by up to 10 degrees to all sides, rotated by up to 20 both ways, spread over the middle of the
// reach. Neighbours in the list are far from each other, so that a drifting zero cannot pass for a tilt. The
// path between two consecutive poses is within reach, and so are those from zero and back.
[[nodiscard]] std::vector<Pose<'W', 'H'>> calibration_poses(const Reach& reach, const Pose<'W', 'R'>& X_WR,
                                                            std::size_t count = kUsualPoses);

struct MachineCalibration {
  std::vector<CarriedStand> stands;
  std::optional<models::WeightFit> weight;     // unset: no force sensor
  std::optional<models::HandEyeFit> hand_eye;  // unset: no tracker
  std::int32_t clamped_tool = -1;              // index in the scene
  double tool_mass = 0.0;                      // kg, of the clamped tool, from the scene
  std::size_t unseen = 0;                      // stands in which the tracker did not see the tool
  double time = kUnset;                        // s of experiment
};

// progress: share done. Ends at the machine's zero. Throws as CarriedTool does, and Error if the measurements
// do not determine the result.
[[nodiscard]] MachineCalibration calibrate_machine(CarriedTool& tool, std::size_t count = kUsualPoses,
                                                   const std::function<void(double)>& progress = {});

}  // namespace enc::trial
