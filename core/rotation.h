// Rotations made from what files and surfaces give: angles, a normal.
#pragma once

#include <cmath>

#include "core/frames.h"

namespace enc {

// A rotation whose z axis is n (unit length), turned least from the reference axes. Continuous but at n = -z.
inline Quat rotation_z_to(const Vec3& n) { return Quat::FromTwoVectors(Vec3::UnitZ(), n); }

// Rotation about the fixed x, then y, then z axis, rad: how files write a rotation.
inline Quat rotation_xyz(const Vec3& angles) {
  return Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Vec3::UnitX());
}

// And back: x and z within +-180 deg, y within +-90. Where y is +-90 only the sum or the difference of the
// others counts: z is then 0.
inline Vec3 angles_xyz(const Quat& rotation) {
  const Mat3 R = rotation.toRotationMatrix();
  const double cos_y = std::hypot(R(0, 0), R(1, 0));
  const double y = std::atan2(-R(2, 0), cos_y);
  if (cos_y < 1e-9) return {std::atan2(-R(1, 2), R(1, 1)), y, 0.0};
  return {std::atan2(R(2, 1), R(2, 2)), y, std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace enc
