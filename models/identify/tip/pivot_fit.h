// Pivot calibration: the tip of a tool relative to its markers, from poses of a tool that is swung about its
// tip. The tip p in T stays at one position c in C. So R p + t = c holds for each pose, which is linear in p
// and c.
//
// A constant error of t moves only c: a constant bias of the tracker does not reach the tip. An error of R
// does more than scatter: least squares take it for rotation and place the tip too near to the markers, by
// about 2 error^2 / swing^2 of its distance. So the equations of a pose are weighted with the rotation of its
// neighbours in time, if these rotate as the pose does. Their errors are independent (instrumental
// variables).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "core/base/frames.h"
#include "models/identify/block_fit.h"

namespace enc::models {

struct PivotPose {
  double time = kUnset;  // s
  Pose<'C', 'T'> X_CT;   // markers' pose, from the tracker
};

inline constexpr std::size_t kFewestPoses = 30;
inline constexpr double kLeastPivotTime = 4.0;             // s of rotation, without gaps and rests
inline constexpr double kLeastSwing = 5.0 * M_PI / 180.0;  // rad, rms: least rotation of each direction
inline constexpr double kMostPivotRms = 2e-3;              // m: above this, the tip did not stay
inline constexpr double kMostPivotOutliers = 0.2;          // share of the poses

struct PivotFit {
  // Along the axes of T, m, each with its 95 % interval.
  std::array<Interval, 3> tip;
  Point<'C'> dimple;                   // position of the tip, including the tracker's bias
  double rms = kUnset, most = kUnset;  // m: tip from the dimple, without outliers
  double wander = kUnset;              // m: largest median over 0.25 s, with outliers
  std::size_t outliers = 0;            // poses left out, farther than 6 standard deviations
  // s, without gaps; a rest stays within 2 deg for 1 s or more.
  double turned = 0.0, rested = 0.0;
  bool neighbours = false;  // poses were weighted with those of their neighbours
  // Rotation of three orthogonal directions of T, rms, rad, least first.
  std::array<double, 3> swing{kUnset, kUnset, kUnset};
  Vec<'T'> least_turned;  // unit: the first of these directions

  [[nodiscard]] Point<'T'> point() const { return {tip[0].value, tip[1].value, tip[2].value}; }
};

// Poses in order of time. Throws Error: fewer than kFewestPoses, or less than kLeastPivotTime; an invalid
// pose; rotation that does not determine each direction of the tip, without outliers; a tip that did not
// stay; a tip with an unknown interval.
[[nodiscard]] PivotFit fit_pivot(std::span<const PivotPose> poses);

// Checks that a log of poses is what it claims. A wrong unit of time or a wrong convention of the pose may
// leave no residual. So the checks use the limits of tools, trackers and hands.

// "rows are 16.7 s apart: milliseconds?" if the poses rotate more slowly than any hand rotates a tool, and
// come as seldom; empty otherwise. Single poses taken one by one rotate by degrees from one to the next.
[[nodiscard]] std::string doubt_of_time(std::span<const PivotPose> poses);

// Poses of the tracker in the tool swap tip and dimple, and leave an equal residual. `doubted`: the tip is
// farther from the markers than a hand-held tool is long, and farther than the dimple is from the tracker.
// `sure`: no tool and no tracker has such distances. Poses may be in a frame with its origin at the dimple:
// then the distances mean less.
struct Inversion {
  bool doubted = false, sure = false;
  std::string text;  // both distances, and the tip if the poses are inverted
};
[[nodiscard]] Inversion doubt_of_direction(const PivotFit& fit);

// Hint for poses with a moving tip: "; ..." if the tip stays with another reading of the quaternion, in each
// of two parts of the log, or with the positions of other rows; else empty.
[[nodiscard]] std::string other_convention(std::span<const PivotPose> poses);

}  // namespace enc::models
