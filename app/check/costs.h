// The parts of a scene at run time and their costs, measured in a short run.
#pragma once

#include <string>

#include "models/setup/scene_file.h"

namespace enc::app {

// Some lines of text. Runs the first quarter of a second of a fully simulated scene. Empty for any other
// scene, because no device may be moved or waited for, and if a camera's modules are not built. `ready` is
// the CPU time of the process so far, s.
[[nodiscard]] std::string costs_text(const models::Setup& setup, std::uint64_t seed, double ready);

}  // namespace enc::app
