// The wire's coordinates are those of Unity: left-handed, x to the right, y up, z forward, in metres. Ours
// are right-handed: y points down, as convert.py of hand-tracking-sdk has it.
#pragma once

#include <array>
#include <span>

#include "core/base/frames.h"

namespace enc::hand {

[[nodiscard]] Vec3 from_wire(double x, double y, double z) noexcept;
// Seven numbers. Invalid if the quaternion's length is not 1 to a hundredth.
[[nodiscard]] Pose<'L', 'K'> pose_from_wire(std::span<const double> values) noexcept;
[[nodiscard]] std::array<double, 3> to_wire(const Vec3& at) noexcept;
[[nodiscard]] std::array<double, 7> pose_to_wire(const Pose<'L', 'K'>& pose) noexcept;

}  // namespace enc::hand
