// Pose of a tracker relative to a machine, and of the tool in the machine's gripper, from simultaneous poses
// of both: `encounter calibrate rig RIG`.
//
//   X_WC X_CT(i) = X_WH(i) X_HT,   X_WC and X_HT unknown
//
// The closed form of Shah (2013, J. Mech. Robotics 5) gives the start; least squares over position and
// rotation follows. X_WC absorbs a constant error of the tracker's positions, so that the tracked tip agrees
// with the machine's.
#pragma once

#include <span>

#include "core/base/frames.h"
#include "models/identify/rig/uncertain.h"

namespace enc::models {

// Means over the time in which a machine stood still.
struct EyeStand {
  Pose<'W', 'H'> X_WH;  // measured by the machine's own encoders
  Pose<'C', 'T'> X_CT;  // tool's pose, from the tracker
};

struct HandEyeFit {
  Pose<'W', 'C'> X_WC;
  // 99 %: m along W's axes, C's origin; rad about them.
  Vec3 place_half, turn_half;
  // m, 99 %: error of a position near W's origin, the tools' region.
  Vec3 origin_half;
  Pose<'H', 'T'> X_HT;
  UncertainVec tip;                        // H's origin in T, m: the tip of the tool in the gripper
  double rms = kUnset, rms_turn = kUnset;  // m and rad, residual of a stand
  double most = kUnset;                    // m, largest residual of a stand
};

// Throws Error if the poses rotate about only one axis, or do not fit each other.
[[nodiscard]] HandEyeFit fit_hand_eye(std::span<const EyeStand> stands);

}  // namespace enc::models
