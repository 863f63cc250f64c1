// Rotations made from what files and surfaces give: angles, a normal.
#pragma once

#include "core/frames.h"

namespace enc {

// A rotation whose z axis is n (unit length), turned least from the reference axes. Continuous but at n = -z.
inline Quat rotation_z_to(const Vec3& n) { return Quat::FromTwoVectors(Vec3::UnitZ(), n); }

// Rotation about the fixed x, then y, then z axis, rad: how files write a rotation.
inline Quat rotation_xyz(const Vec3& angles) {
  return Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Vec3::UnitX());
}

}  // namespace enc
