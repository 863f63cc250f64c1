// The interface to the module of calibrations from images, the only one that maps OpenCV. It is built and
// loaded only for `calibrate stereo` or `calibrate skin`.
#pragma once

#include "app/common/module_options.h"

namespace enc::app {

// Each function is a subcommand: it prints its results, returns the exit code, and throws Error.
struct CalibrationModule {
  int (*stereo)(const StereoOptions& options) = nullptr;
  int (*skin)(const SkinOptions& options) = nullptr;
};

}  // namespace enc::app
