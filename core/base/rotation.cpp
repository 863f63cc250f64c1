#include "core/base/rotation.h"

#include <cmath>

namespace enc {

// The one file that calls FromTwoVectors: Eigen uses an SVD for opposite directions, which costs each file
// that includes it eight seconds.
Quat rotation_between(const Vec3& from, const Vec3& to) { return Quat::FromTwoVectors(from, to); }

Quat rotation_z_to(const Vec3& n) { return rotation_between(Vec3::UnitZ(), n); }

Quat rotation_xyz(const Vec3& angles) {
  return Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Vec3::UnitX());
}

Vec3 angles_xyz(const Quat& rotation) {
  const Mat3 R = rotation.toRotationMatrix();
  const double cos_y = std::hypot(R(0, 0), R(1, 0));
  const double y = std::atan2(-R(2, 0), cos_y);
  if (cos_y < 1e-9) return {std::atan2(-R(1, 2), R(1, 1)), y, 0.0};
  return {std::atan2(R(2, 1), R(2, 2)), y, std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace enc
