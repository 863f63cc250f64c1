// encounter view: a picture of the simulated world at a moment.
#pragma once

#include "app/common/options.h"

namespace enc::app {

enum class Look { machine, contact };  // the whole machine, or a close-up of the contact

// Writes options.shot; `view` is this with Look::machine. options.at unset: when the first press is held,
// else at 4 s.
int picture(const ViewOptions& options, Look look);
// With --through-camera: what the left camera of the scene sees.
int through_camera(const ViewOptions& options);
// Throws Error for what the words must not be.
void check(const ViewOptions& options);

}  // namespace enc::app
