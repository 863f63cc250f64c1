// Prepares a set-up for step(): enough for every command that moves nothing.
#pragma once

#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

// prepare(); an error names its place in the file.
[[nodiscard]] Scene prepare_setup(const models::Setup& setup);

}  // namespace enc::trial
