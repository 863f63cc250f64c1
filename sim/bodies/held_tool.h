// A tool of the user: its body, and the data that tracker and truth need.
#pragma once

#include <cstdint>

#include "core/base/frames.h"

namespace enc::sim {

struct HeldTool {
  std::int32_t index = -1;  // index in the scene
  int body = -1, qpos = 0, qvel = 0;
  Vec3 tip_T, shaft_T;  // centre of its tip; from there to the markers
  double radius = kUnset;
};

}  // namespace enc::sim
