// The subjects of `calibrate` that read a folder of images, a file each, and what both write.
#pragma once

#include <string>

#include "app/common/calibrate_options.h"

namespace enc::app {

int calibrate_stereo(const StereoOptions& options);
int calibrate_skin(const SkinOptions& options);

// What made a file, as its first line: whoever repeats it gets the same numbers. command: behind `calibrate`.
[[nodiscard]] std::string made_by(const std::string& command);

// Throws Error: the report is what is printed, so a file has a name.
void refuse_dash(const std::string& option, const std::string& name);

}  // namespace enc::app
