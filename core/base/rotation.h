// Rotations made from angles (files) and normals (surfaces). These functions are not inline: Eigen's code for
// the least rotation between two vectors would cost each including file four seconds.
#pragma once

#include "core/base/frames.h"

namespace enc {

// The least rotation that turns `from` into the direction of `to`; neither may be zero.
[[nodiscard]] Quat rotation_between(const Vec3& from, const Vec3& to);

// The rotation whose z axis is n (unit length) and that turns the reference axes least. Continuous except at
// n = -z.
[[nodiscard]] Quat rotation_z_to(const Vec3& n);

// Rotation about the fixed x, then y, then z axis, rad: the order in which files write a rotation.
[[nodiscard]] Quat rotation_xyz(const Vec3& angles);

// The inverse of rotation_xyz(): x and z within +-180 deg, y within +-90 deg. At y = +-90 deg only the sum or
// difference of x and z is defined, and z is then 0.
[[nodiscard]] Vec3 angles_xyz(const Quat& rotation);

}  // namespace enc
