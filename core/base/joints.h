// One number for each joint of an arm.
#pragma once

#include <array>
#include <cstddef>

namespace enc {

inline constexpr std::size_t kMostJoints = 3;
// rad or m, N m or N. Entries beyond the machine's joints are 0.
using PerJoint = std::array<double, kMostJoints>;

}  // namespace enc
