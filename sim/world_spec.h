// The inputs of a twin, and the true pose of its machine.
#pragma once

#include <cstdint>
#include <string>

#include "core/control/scene/scene.h"
#include "sim/spec/twin_spec.h"

namespace enc::sim {

struct WorldSpec {
  const SceneSpec& scene;
  const RigSpec& rig;
  const TwinSpec& twin;
  const Scene& prepared;  // must outlive the world: the display draws its surfaces
  std::string mjcf_dir;
  std::uint64_t seed = 1;
  bool draw_all = false;
};

// The base for which H would be W at the machine's zero, with its error: rotated about W, so that a rotation
// alone moves nothing there.
[[nodiscard]] Pose<'W', 'R'> hexapod_base(const HexapodTruth& truth);
[[nodiscard]] Pose<'W', 'R'> arm_base(const ArmTruth& truth);

}  // namespace enc::sim
