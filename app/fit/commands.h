// The subcommands of the module except those of `calibrate`, one file each.
#pragma once

#include "app/common/options.h"

namespace enc::app {

int fit_loop(const FitOptions& options);  // fits a response to a measured loop
int fit_ball(const FitOptions& options);  // fits the ball behind the loops
// Compares a record with its twin.
int shadow_command(const ShadowOptions& options);

}  // namespace enc::app
