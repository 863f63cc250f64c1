// The subcommands of the module of fits, one file each, and the refusals that those of `calibrate` share. The
// subcommands print their results, return the exit code, and throw Error.
#pragma once

#include <string>

#include "app/common/module_options.h"
#include "app/common/options.h"
#include "trial/assemble/assemble.h"

namespace enc::app {

int fit_loop(const FitOptions& options);  // fits a response to a measured loop
int fit_ball(const FitOptions& options);  // fits the ball behind the loops
// Compares a record with its twin.
int shadow_command(const ShadowOptions& options);
int calibrate_tracker(const TrackerOptions& options);
int calibrate_tip(const TipOptions& options);
// modules: source of vision and the twin's camera, which only pictures need.
int calibrate_camera(const CameraOptions& options, const trial::DriverSource& modules);
int calibrate_rig(const RigOptions& options, const trial::DriverSource& modules);

// Both throw Error if the table belongs to another subject; the message names that subject's command.
// expected: the input of this subject.
void refuse_pairs(const std::string& csv, const std::string& file, const std::string& expected);
void refuse_poses(const std::string& csv, const std::string& file, const std::string& expected);
// True for a rig: names of rigs have neither dot nor slash, and their files are TOML. Anything else is a
// table.
[[nodiscard]] bool is_rig(const std::string& what);

}  // namespace enc::app
