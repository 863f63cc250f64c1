// Registration of camera and device from positions of the device's tip reported by both: absolute orientation
// in closed form, by unit quaternions [VisHap 2.2; Horn 1987, J. Opt. Soc. Am. A 4].
//
// Camera and device are rigid frames of equal scale and handedness: the answer is always a proper rotation
// without scaling. Points in one plane are enough; points on one line or in one place are not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

// One position of the tip.
struct PointPair {
  Point<'C'> camera;
  Point<'W'> device;
};

inline constexpr std::size_t kFewestPairs = 4;  // "more than three pairs" [VisHap 2.2]
inline constexpr double kMostCondition = 100.0;

struct Registration {
  Pose<'W', 'C'> X_WC;
  // Residual X_WC * camera - device, along the axes of W, m.
  Vec3 mean_error{kUnset, kUnset, kUnset};  // mean of the absolute value
  Vec3 rms_error{kUnset, kUnset, kUnset};
  // Accuracy of the rotation about the set's longest axis relative to the best known rotation: 1 for points
  // all around, infinite for points on a line. Value of the worse set.
  double condition = kUnset;
  // Camera's size over the device's, from both sets about their middles. Rigid frames: 1 except for noise.
  double scale = kUnset;
  double rms = kUnset;  // all three axes together, m
  // Residual of the best mirror image: far below rms if an axis is reversed.
  double mirror_rms = kUnset;
};

// Least squares over all pairs. Throws Error for fewer than `fewest` pairs (3 fix a pose, but reveal no
// error) or a number that is not finite. It also does for points in one place or on one line. Points thinner
// than 1 % of their length determine the rotation about it a hundred times less accurately than the others.
[[nodiscard]] Registration register_points(std::span<const PointPair> pairs,
                                           std::size_t fewest = kFewestPairs);

// Positions of a device's tip seen by a camera, as a file: comma-separated columns camera_x_m, camera_y_m,
// camera_z_m (in C), device_x_m, device_y_m, device_z_m (in W, reported by the device). If the tip stood
// still for several frames, there is a column pair: rows with one number are frames of one position.
struct SeenPlace {
  std::int64_t number = 0;  // number in the file
  std::vector<PointPair> frames;

  // Mean of the first `count` frames, or of all if there are fewer.
  [[nodiscard]] PointPair average(std::size_t count = SIZE_MAX) const;
};
using PointSet = std::vector<SeenPlace>;

[[nodiscard]] std::vector<PointPair> averages(const PointSet& places, std::size_t frames = SIZE_MAX);

// True if this text begins with such a header; else it is another kind of table.
[[nodiscard]] bool is_point_set(const std::string& text);

// name: of the file, for messages "name:line:column: ...". Throws Error: a missing column, not a number, a
// position beyond 10 m, a tip that moved between the frames of a pair, too few pairs, positions on one line
// or in one point, sets of different size, mirror images. Every returned set can be registered.
[[nodiscard]] PointSet parse_points(const std::string& text, const std::string& name);
[[nodiscard]] std::string points_text(const PointSet& places);

}  // namespace enc::models
