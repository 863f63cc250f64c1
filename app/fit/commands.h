// The subcommands of the module, a file each.
#pragma once

#include <string>

#include "app/common/options.h"
#include "trial/assemble/assemble.h"

namespace enc::app {

int fit_loop(const FitOptions& options);  // a response out of a measured loop
int fit_ball(const FitOptions& options);  // the ball behind the loops
// A tracker's log, a tool that is swung, a set of points or a rig: it looks which of them it is.
int calibrate_command(const CalibrateOptions& options, const trial::DriverSource& modules);
int calibrate_points(const std::string& csv, const CalibrateOptions& options);
int calibrate_pivot(const std::string& csv, const CalibrateOptions& options);
int calibrate_arm(const CalibrateOptions& options, const trial::DriverSource& modules);
int calibrate_machine(const CalibrateOptions& options, const trial::DriverSource& modules);
// A record beside its twin.
int shadow_command(const ShadowOptions& options);
// A table for all of these: the file, or of a record what `encounter export` makes of it.
std::string read_table(const std::string& path, const std::string& what, const std::string& expected);

}  // namespace enc::app
