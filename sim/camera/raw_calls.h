// MuJoCo's own calls for a pair of images, of a stage's room and hand, and nothing else: what drawing costs
// without us. For benchmarks.
#pragma once

#include <functional>

#include "sim/camera/stage.h"

namespace enc::sim {

// mjv_updateScene, then mjr_render and mjr_readPixels for each eye. Throws as Stage does.
[[nodiscard]] std::function<void(const HandPose& hand)> raw_calls(const StageSpec& spec);

}  // namespace enc::sim
