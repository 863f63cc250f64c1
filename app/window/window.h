// `encounter view` without --shot: a run in a window, in which the mouse moves the hand.
#pragma once

#include "app/common/options.h"

namespace enc::app {

// Prints the report of `encounter run` and returns its exit code once the window is closed or the run ends.
int window(const ViewOptions& options);

}  // namespace enc::app
