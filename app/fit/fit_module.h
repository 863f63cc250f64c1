// What the program asks of the module of fits. It is built and loaded when `fit` or `calibrate` is called.
#pragma once

#include "app/options.h"

namespace enc::app {

// Each is a subcommand: prints what it has to say, gives the exit code, throws Error.
struct FitModule {
  int (*fit)(const FitOptions& options) = nullptr;
  int (*calibrate)(const CalibrateOptions& options) = nullptr;
};

}  // namespace enc::app
