// Rotations made from what files and surfaces give: angles, a normal. Not inline: what Eigen instantiates for
// the least rotation between two vectors would cost every file that includes this four seconds.
#pragma once

#include "core/base/frames.h"

namespace enc {

// The least rotation that turns `from` to the direction of `to`; neither may be zero.
[[nodiscard]] Quat rotation_between(const Vec3& from, const Vec3& to);

// A rotation whose z axis is n (unit length), turned least from the reference axes. Continuous but at n = -z.
[[nodiscard]] Quat rotation_z_to(const Vec3& n);

// Rotation about the fixed x, then y, then z axis, rad: how files write a rotation.
[[nodiscard]] Quat rotation_xyz(const Vec3& angles);

// And back: x and z within +-180 deg, y within +-90. Where y is +-90 only the sum or the difference of the
// others counts: z is then 0.
[[nodiscard]] Vec3 angles_xyz(const Quat& rotation);

}  // namespace enc
