// Zero error of a force sensor, its load and its mounting, from a machine that stands in many poses with only
// weight on the sensor: `encounter calibrate rig RIG`.
//
//   force(i) = X_HF^-1 X_WH(i)^-1 (0, 0, -m g) + zero(i),   zero: a random walk
//
// Generalised least squares. The ratio of the zero's walk to the error of a stand's mean is estimated from
// the stands themselves (restricted maximum likelihood). So a drifting zero makes the intervals wide and not
// wrong. The machine's base is assumed level.
#pragma once

#include <span>

#include "core/base/frames.h"
#include "core/base/sample.h"
#include "models/identify/rig/uncertain.h"

namespace enc::models {

// Means over the time in which a machine stood still.
struct WeightStand {
  double time = kUnset;  // s, middle of that time
  Pose<'W', 'H'> X_WH;   // measured by the machine's own encoders
  Wrench wrench;         // raw
};

struct WeightFit {
  Uncertain mass;        // kg, everything behind the sensor
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
