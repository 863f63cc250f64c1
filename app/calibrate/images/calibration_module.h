// What the program asks of the module of calibrations out of images, which alone maps OpenCV. It is built and
// loaded when `calibrate stereo` or `calibrate skin` is called.
#pragma once

#include "app/common/calibrate_options.h"

namespace enc::app {

// Each is a subcommand: prints what it has to say, gives the exit code, throws Error.
struct CalibrationModule {
  int (*stereo)(const StereoOptions& options) = nullptr;
  int (*skin)(const SkinOptions& options) = nullptr;
};

}  // namespace enc::app
