// The drivers that a rig file names, held against those that are there.
#pragma once

#include "models/setup/scene_file.h"

namespace enc::app {

// Throws Error (kind input) with the place where a role that the scene names has a driver that is not there,
// or one that does not fill it. Where no driver is there at all nothing can be said of a name: then the
// module is missing, which only a run wants.
void check_driver_names(const models::Setup& setup);

}  // namespace enc::app
