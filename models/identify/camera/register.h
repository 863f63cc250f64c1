// Where camera and device stand to each other, out of places of the device's tip that both have told:
// absolute orientation in closed form, by unit quaternions [VisHap 2.2; Horn 1987, J. Opt. Soc. Am. A 4].
//
// Camera and device are rigid frames of the same size and the same hand: the answer is always a proper
// rotation and never stretches. Points in one plane are enough; points on one line or in one place are not.
#pragma once

#include <cstddef>
#include <span>

#include "core/base/frames.h"

namespace enc::models {

// One place of the tip.
struct PointPair {
  Point<'C'> camera;
  Point<'W'> device;
};

inline constexpr std::size_t kFewestPairs = 4;  // "more than three pairs" [VisHap 2.2]
inline constexpr double kMostCondition = 100.0;

struct Registration {
  Pose<'W', 'C'> X_WC;
  // Of X_WC * camera - device, along the axes of W, m: what the pairs themselves leave over.
  Vec3 mean_error{kUnset, kUnset, kUnset};  // mean of the absolute value
  Vec3 rms_error{kUnset, kUnset, kUnset};
  // How much worse the turn about the set's longest axis is known than the one that is known best: 1 for
  // points all around, infinite for points on a line. Of the worse of both sets.
  double condition = kUnset;
  // Camera's size over the device's, of both sets about their middles. Rigid frames: 1 but for noise.
  double scale = kUnset;
  double rms = kUnset;  // of all three axes together, m
  double mirror_rms =
      kUnset;  // what the best mirror image would leave: far less than rms where an axis is reversed
};

// Least squares over all pairs. Throws Error where fewer than `fewest` are given (3 fix a pose, but leave
// nothing to see a mistake by), where a number is not finite, or where the points are in one place or on one
// line: thinner than 1 % of their length, they tell the turn about it less well than a hundredth of the
// others.
[[nodiscard]] Registration register_points(std::span<const PointPair> pairs,
                                           std::size_t fewest = kFewestPairs);

}  // namespace enc::models
