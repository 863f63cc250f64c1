// Checks the driver names of a rig file against the available drivers.
#pragma once

#include "models/setup/scene_file.h"

namespace enc::app {

// Throws Error (kind input) with the place if a role of the scene has an unavailable driver, or one that does
// not fill it. Without any available driver no name can be judged: the module is then missing, which matters
// only for a run.
void check_driver_names(const models::Setup& setup);

}  // namespace enc::app
