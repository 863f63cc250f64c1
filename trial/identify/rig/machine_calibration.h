// `encounter calibrate rig RIG`: the machine carries a clamped tool through poses that tilt and turn to all
// sides; out of what force sensor and tracker say there come the numbers that a rig believes.
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

// Tilted by up to 10 degrees to all sides, turned by up to 20 to both, spread over the middle of the reach;
// neighbours in the list are far from each other, so that a zero that drifts is not taken for a tilt. The way
// between any two that follow each other is within reach, and so are those from zero and back.
[[nodiscard]] std::vector<Pose<'W', 'H'>> calibration_poses(const Reach& reach, const Pose<'W', 'R'>& X_WR,
                                                            std::size_t count = kUsualPoses);

struct MachineCalibration {
  std::vector<CarriedStand> stands;
  std::optional<models::WeightFit> weight;     // none: there is no force sensor
  std::optional<models::HandEyeFit> hand_eye;  // none: there is no tracker
  std::int32_t clamped_tool = -1;              // in the scene
  double tool_mass = 0.0;                      // kg, of that, as the scene has it
  std::size_t unseen = 0;                      // stands in which the tracker did not see the tool
  double time = kUnset;                        // s of experiment
};

// progress: share done. Ends at the machine's zero. Throws as CarriedTool does, and Error where what was
// measured does not tell what is asked.
[[nodiscard]] MachineCalibration calibrate_machine(CarriedTool& tool, std::size_t count = kUsualPoses,
                                                   const std::function<void(double)>& progress = {});

}  // namespace enc::trial
