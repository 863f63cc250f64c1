// Zero error of a force sensor, what it carries and how it is mounted, out of a machine that stands in many
// poses with nothing but weight on the sensor: `encounter calibrate rig RIG`.
//
//   force(i) = X_HF^-1 X_WH(i)^-1 (0, 0, -m g) + zero(i),   zero: a random walk
//
// Generalised least squares. How much the zero walks against how much a stand's mean is off is taken out of
// the stands themselves (restricted maximum likelihood), so that a zero that drifts makes the intervals wide
// and not wrong. The machine's base is taken for level.
#pragma once

#include <span>

#include "core/base/frames.h"
#include "core/base/sample.h"
#include "models/identify/rig/uncertain.h"

namespace enc::models {

// Means over the time in which a machine stood still.
struct WeightStand {
  double time = kUnset;  // s, of its middle
  Pose<'W', 'H'> X_WH;   // by the machine's own encoders
  Wrench wrench;         // raw
};

struct WeightFit {
  Uncertain mass;        // kg, all that is behind the sensor
  UncertainVec zero;     // N in F, at `end`
  Quat R_HF;             // the sensor's turn under the tip
  Vec3 turn_half;        // rad, 99 %, about F's axes
  Vec<'F'> middle;       // of what is behind the sensor, from F's origin, m
  double rms = kUnset;   // N, what is left over of a stand
  double most = kUnset;  // N, of the stand that is farthest off
  double walk = kUnset;  // N / sqrt(s), of the zero
};

// Of the weight's direction, rms to each side: 3 degrees.
inline constexpr double kLeastWeightSwing = 0.05;

// Throws Error where the poses turn too little to tell weight from zero, and where what is measured does not
// turn as a weight does: something touches. end: s, not before the last stand; unset: of that.
[[nodiscard]] WeightFit fit_weight(std::span<const WeightStand> stands, double end = kUnset);

}  // namespace enc::models
