#include "hw_drivers/hand/wire/coordinates.h"

#include <cmath>

namespace enc::hand {

Vec3 from_wire(double x, double y, double z) noexcept { return {x, -y, z}; }

// A mirrored axis turns the other way: of the quaternion's vector x and z change their signs, y keeps its.
Pose<'L', 'K'> pose_from_wire(std::span<const double> values) noexcept {
  constexpr double kLength = 0.01;
  const Quat q(values[6], -values[3], values[4], -values[5]);
  if (!(std::abs(q.norm() - 1.0) < kLength)) return {};
  return {q.normalized(), from_wire(values[0], values[1], values[2])};
}

std::array<double, 3> to_wire(const Vec3& at) noexcept { return {at.x(), -at.y(), at.z()}; }

std::array<double, 7> pose_to_wire(const Pose<'L', 'K'>& pose) noexcept {
  const auto at = to_wire(pose.p());
  const Quat q = pose.q();
  return {at[0], at[1], at[2], -q.x(), q.y(), -q.z(), q.w()};
}

}  // namespace enc::hand
