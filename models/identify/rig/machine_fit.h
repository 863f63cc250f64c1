// The fits of `encounter calibrate rig RIG`: the pose of a tracker relative to a machine, and the zero, load
// and mounting of its force sensor.
#pragma once

#include <cmath>
#include <span>

#include "core/base/frames.h"
#include "core/base/sample.h"
#include "models/identify/block_fit.h"

namespace enc::models {

// A number with its uncertainty.
inline constexpr double kNormal99 = 2.575829;  // two-sided quantile of 99 %

// Half of the width of the 99 % interval. A wrong calibration moves a machine to a wrong position, so its
// intervals are wider than those of a report.
struct UncertainValue {
  double value = kUnset, half = kUnset;
  [[nodiscard]] bool holds(double x) const { return std::abs(x - value) <= half; }
};
struct UncertainVec {
  Vec3 value{kUnset, kUnset, kUnset}, half{kUnset, kUnset, kUnset};
  [[nodiscard]] bool holds(const Vec3& x) const { return ((x - value).array().abs() <= half.array()).all(); }
};

// Pose of a tracker relative to a machine, and of the tool in the machine's gripper, from simultaneous poses
// of both: `encounter calibrate rig RIG`.
//
//   X_WC X_CT(i) = X_WH(i) X_HT,   X_WC and X_HT unknown
//
// The closed form of Shah (2013, J. Mech. Robotics 5) gives the start; least squares over position and
// rotation follows. X_WC absorbs a constant error of the tracker's positions, so that the tracked tip agrees
// with the machine's.

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

// Zero error of a force sensor, its load and its mounting, from a machine that stands in many poses with only
// weight on the sensor: `encounter calibrate rig RIG`.
//
//   force(i) = X_HF^-1 X_WH(i)^-1 (0, 0, -m g) + zero(i),   zero: a random walk
//
// Generalised least squares. The ratio of the zero's walk to the error of a stand's mean is estimated from
// the stands themselves (restricted maximum likelihood). So a drifting zero makes the intervals wide and not
// wrong. The machine's base is assumed level.

// Means over the time in which a machine stood still.
struct WeightStand {
  double time = kUnset;  // s, middle of that time
  Pose<'W', 'H'> X_WH;   // measured by the machine's own encoders
  Wrench wrench;         // raw
};

struct WeightFit {
  UncertainValue mass;   // kg, everything behind the sensor
  UncertainVec zero;     // N in F, at `end`
  Quat R_HF;             // rotation of the sensor under the tip
  Vec3 turn_half;        // rad, 99 %, about F's axes
  Vec<'F'> middle;       // centre of mass behind the sensor, from F's origin, m
  double rms = kUnset;   // N, residual of a stand
  double most = kUnset;  // N, largest residual of a stand
  double walk = kUnset;  // N / sqrt(s), zero
};

// Least swing of the weight's direction, rms to each side: 3 degrees.
inline constexpr double kLeastWeightSwing = 0.05;

// Throws Error if the poses rotate too little to separate weight and zero, or if the measured force does not
// rotate as a weight does: the tool touches something. end: s, not before the last stand; unset: the last
// stand.
[[nodiscard]] WeightFit fit_weight(std::span<const WeightStand> stands, double end = kUnset);

}  // namespace enc::models
