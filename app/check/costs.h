// What a scene is made of at run time, and what that costs: asked of a short run, not of a list.
#pragma once

#include <string>

#include "models/setup/scene_file.h"

namespace enc::app {

// Some lines. Runs the first quarter of a second of a scene that is all simulated; of another nothing: a
// device is not to be moved, nor to be waited for; nor where a camera's modules are not built. `ready` is the
// CPU time of the process so far, s.
[[nodiscard]] std::string costs_text(const models::Setup& setup, std::uint64_t seed, double ready);

}  // namespace enc::app
