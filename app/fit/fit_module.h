// What the program asks of the module of fits. It is built and loaded when `fit`, `calibrate` or `shadow`
// is called.
#pragma once

#include "app/common/options.h"
#include "trial/assemble/assemble.h"

namespace enc::app {

// Each is a subcommand: prints what it has to say, gives the exit code, throws Error.
struct FitModule {
  int (*fit)(const FitOptions& options) = nullptr;
  // modules: where vision and the twin's camera come from, which only pictures need.
  int (*calibrate)(const CalibrateOptions& options, const trial::DriverSource& modules) = nullptr;
  int (*shadow)(const ShadowOptions& options) = nullptr;
};

}  // namespace enc::app
