// Where a tracker stands to a machine, and how the machine holds the tool that the tracker sees, out of poses
// that both have told at the same time: `encounter calibrate rig RIG`.
//
//   X_WC X_CT(i) = X_WH(i) X_HT,   X_WC and X_HT unknown
//
// The closed form of Shah (2013, J. Mech. Robotics 5) begins; least squares over place and turn follows. A
// constant error of the tracker's places is in X_WC, so that the tip is seen where the machine has it.
#pragma once

#include <span>

#include "core/base/frames.h"
#include "models/identify/rig/uncertain.h"

namespace enc::models {

// Means over the time in which a machine stood still.
struct EyeStand {
  Pose<'W', 'H'> X_WH;  // by the machine's own encoders
  Pose<'C', 'T'> X_CT;  // of the tool, by the tracker
};

struct HandEyeFit {
  Pose<'W', 'C'> X_WC;
  Vec3 place_half, turn_half;  // 99 %: m along W's axes, of C's origin; rad about them
  Vec3 origin_half;            // m, 99 %: of what is seen at W's origin, where tools are
  Pose<'H', 'T'> X_HT;
  UncertainVec tip;                        // H's origin in T, m: where the tool's tip is that stands there
  double rms = kUnset, rms_turn = kUnset;  // m and rad, what is left over of a stand
  double most = kUnset;                    // m, of the stand that is farthest off
};

// Throws Error where the poses turn about one axis alone, or do not fit each other.
[[nodiscard]] HandEyeFit fit_hand_eye(std::span<const EyeStand> stands);

}  // namespace enc::models
