// The subjects of `calibrate` that read a folder of images, one file each, and their shared output.
#pragma once

#include <string>

#include "app/common/module_options.h"

namespace enc::app {

int calibrate_stereo(const StereoOptions& options);
int calibrate_skin(const SkinOptions& options);

// The command that made a file, as its first line: repeating it gives equal numbers. command: the words after
// `calibrate`.
[[nodiscard]] std::string made_by(const std::string& command);

}  // namespace enc::app
