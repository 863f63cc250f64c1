// Checks that a log of poses is what it claims. A wrong unit of time or a wrong convention of the pose may
// leave no residual. So the checks use the limits of tools, trackers and hands.
#pragma once

#include <span>
#include <string>

#include "models/identify/tip/pivot_fit.h"

namespace enc::models {

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
