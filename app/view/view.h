// encounter view: a picture of the simulated world at a moment.
#pragma once

#include "app/common/options.h"

namespace enc::app {

enum class Look { machine, contact };  // the whole machine, or a close-up of the contact

// Writes options.shot; `view` calls this with Look::machine. options.at unset: during the hold of the first
// press, else at 4 s.
int picture(const ViewOptions& options, Look look);
// Handles --through-camera: the image of the scene's left camera.
int through_camera(const ViewOptions& options);
// Throws Error for invalid options.
void check(const ViewOptions& options);

}  // namespace enc::app
