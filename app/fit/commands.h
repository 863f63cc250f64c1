// The subcommands of the module but those of `calibrate`, a file each.
#pragma once

#include "app/common/options.h"

namespace enc::app {

int fit_loop(const FitOptions& options);  // a response out of a measured loop
int fit_ball(const FitOptions& options);  // the ball behind the loops
// A record beside its twin.
int shadow_command(const ShadowOptions& options);

}  // namespace enc::app
