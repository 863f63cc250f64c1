#include "core/rotation.h"

#include <algorithm>
#include <cmath>

namespace enc {

// As Eigen's FromTwoVectors, bit by bit, but for opposite directions, where that takes an SVD: eight seconds
// of every build. There any axis at right angles will do; this is the image of z in the reflection that takes
// `from` to x.
Quat rotation_between(const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized();
  const Vec3 b = to.normalized();
  const double cosine = b.dot(a);
  if (cosine < -1.0 + 1e-12) {
    const Vec3 both = a.cross(b);
    const Vec3 mirror = Vec3(a.x() + (a.x() < 0.0 ? -1.0 : 1.0), a.y(), a.z()).normalized();
    const Vec3 axis =
        both.norm() > 1e-8 ? both.normalized() : Vec3(Vec3::UnitZ() - 2.0 * mirror.z() * mirror);
    const double squared = (1.0 + std::max(cosine, -1.0)) * 0.5;
    Quat opposite;
    opposite.w() = std::sqrt(squared);
    opposite.vec() = axis * std::sqrt(1.0 - squared);
    return opposite;
  }
  const Vec3 axis = a.cross(b);
  const double s = std::sqrt((1.0 + cosine) * 2.0);
  Quat turn;
  turn.vec() = axis * (1.0 / s);
  turn.w() = s * 0.5;
  return turn;
}

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
