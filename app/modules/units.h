// In what the subcommands of modules tell lengths, times and angles, and the names of the axes.
#pragma once

#include <cmath>

namespace enc::app {

inline constexpr double kMm = 1e3, kMs = 1e3, kDeg = 180.0 / M_PI;  // in a metre, a second, a radian
inline constexpr const char* kNames = "xyz";

}  // namespace enc::app
