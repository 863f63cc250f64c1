// What the program asks of the module of calibrations, which alone maps OpenCV. It is built and loaded when
// `calibrate` is given a folder.
#pragma once

#include "app/common/options.h"

namespace enc::app {

// Prints what it has to say, gives the exit code, throws Error.
struct CalibrationModule {
  int (*calibrate)(const CalibrateOptions& options) = nullptr;
};

}  // namespace enc::app
