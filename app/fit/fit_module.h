// What the program asks of the module of fits. It is built and loaded when `fit` or `shadow` is called, or
// `calibrate` of a tracker, a tip, a camera or a rig.
#pragma once

#include "app/common/calibrate_options.h"
#include "app/common/options.h"
#include "trial/assemble/assemble.h"

namespace enc::app {

// Each is a subcommand: prints what it has to say, gives the exit code, throws Error.
struct FitModule {
  int (*fit)(const FitOptions& options) = nullptr;
  int (*shadow)(const ShadowOptions& options) = nullptr;
  int (*tracker)(const TrackerOptions& options) = nullptr;
  int (*tip)(const TipOptions& options) = nullptr;
  // modules: where vision and the twin's camera come from, which only pictures need.
  int (*camera)(const CameraOptions& options, const trial::DriverSource& modules) = nullptr;
  int (*rig)(const RigOptions& options, const trial::DriverSource& modules) = nullptr;
};

}  // namespace enc::app
