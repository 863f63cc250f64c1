// The subjects of `calibrate` that the module of fits serves, a file each: print what they have found, give
// the exit code, throw Error.
#pragma once

#include <string>

#include "app/common/calibrate_options.h"
#include "trial/assemble/assemble.h"

namespace enc::app {

int calibrate_tracker(const TrackerOptions& options);
int calibrate_tip(const TipOptions& options);
// modules: where vision and the twin's camera come from, which only pictures need.
int calibrate_camera(const CameraOptions& options, const trial::DriverSource& modules);
int calibrate_rig(const RigOptions& options, const trial::DriverSource& modules);

// Throws Error where the table is another subject's; its message names that subject's command.
// expected: what the subject reads.
void refuse_pairs(const std::string& csv, const std::string& file, const std::string& expected);
void refuse_poses(const std::string& csv, const std::string& file, const std::string& expected);
// Names of rigs have neither dot nor slash, and their files are TOML; all else is a table.
[[nodiscard]] bool is_rig(const std::string& what);

}  // namespace enc::app
