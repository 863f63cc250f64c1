// What step() needs of a set-up: all that a command asks for that moves nothing.
#pragma once

#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

// prepare(), with the place in the file put before what is wrong.
[[nodiscard]] Scene prepare_setup(const models::Setup& setup);

}  // namespace enc::trial
