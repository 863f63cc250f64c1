// Where the tip of a tool is in its markers, out of poses of a tool that is swung about its tip: pivot
// calibration. The tip p in T stays at one place c in C, so R p + t = c holds for each pose, which is linear
// in p and c.
//
// A constant error of t moves c alone: a constant bias of the tracker does not reach the tip. An error of R
// does more than scatter. Least squares take it for turning and put the tip too near to the markers, by about
// 2 error^2 / swing^2 of its distance. So the equations of a pose are weighed with the rotation of its
// neighbours in time, whose errors are others (instrumental variables), where these turn as the pose does.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/base/frames.h"
#include "models/identify/block_error.h"

namespace enc::models {

struct PivotPose {
  double time = kUnset;  // s
  Pose<'C', 'T'> X_CT;   // of the markers, as the tracker says
};

inline constexpr std::size_t kFewestPoses = 30;
inline constexpr double kLeastPivotTime = 4.0;             // s, in which it turns: without gaps and rests
inline constexpr double kLeastSwing = 5.0 * M_PI / 180.0;  // rad, rms: by what each direction has to turn
inline constexpr double kMostPivotRms = 2e-3;              // m: with more the tip did not stay
inline constexpr double kMostPivotOutliers = 0.2;          // of the poses

struct PivotFit {
  std::array<Interval, 3> tip;         // along the axes of T, m, each with its 95 % interval
  Point<'C'> dimple;                   // where the tip stayed, with the tracker's bias
  double rms = kUnset, most = kUnset;  // m: of the tip from the dimple, without outliers
  double wander = kUnset;              // m: the most of medians over 0.25 s, with outliers
  std::size_t outliers = 0;            // poses that were left out, farther than 6 standard deviations
  double turned = 0.0, rested = 0.0;  // s, without gaps; it rests while it stays within 2 deg for 1 s or more
  bool neighbours = false;            // poses were weighed with those of their neighbours
  // By what three directions of T turned, rms, rad, least first; they are at right angles to one another.
  std::array<double, 3> swing{kUnset, kUnset, kUnset};
  Vec<'T'> least_turned;  // unit: the first of them

  [[nodiscard]] Point<'T'> point() const { return {tip[0].value, tip[1].value, tip[2].value}; }
};

// Poses in the order of time. Throws Error: fewer than kFewestPoses, or less than kLeastPivotTime; a pose
// that is none; turning that does not tell each direction of the tip, outliers left out; a tip that did not
// stay; a tip whose interval is not known.
[[nodiscard]] PivotFit fit_pivot(std::span<const PivotPose> poses);

}  // namespace enc::models
