// Is a log of poses what it is taken for? A wrong unit of time or a wrong convention of the pose may leave no
// residual, so they are looked for by what a tool, a tracker and a hand can be.
#pragma once

#include <span>
#include <string>

#include "models/identify/tip/pivot_fit.h"

namespace enc::models {

// "rows are 16.7 s apart: milliseconds?" where the poses turn as slowly as no hand turns a tool, and come as
// seldom; empty otherwise. Poses that were taken singly turn by degrees from one to the next.
[[nodiscard]] std::string doubt_of_time(std::span<const PivotPose> poses);

// Poses of the tracker in the tool swap tip and dimple and leave the same residual. `doubted`: the tip is
// farther from the markers than a hand-held tool is long, and farther than the dimple is from the tracker.
// `sure`: no tool and no tracker is like that. Poses may be in a frame that has its origin at the dimple:
// then the distances say less.
struct Inversion {
  bool doubted = false, sure = false;
  std::string text;  // both distances, and the tip if the poses are inverted
};
[[nodiscard]] Inversion doubt_of_direction(const PivotFit& fit);

// Looks at poses whose tip did not stay: "; ..." where it stays with the quaternion read otherwise, in each
// of two parts of the log, or with the places of other rows; else empty.
[[nodiscard]] std::string other_convention(std::span<const PivotPose> poses);

}  // namespace enc::models
