// The interface to the module of fits. It is built and loaded only for `fit`, `shadow`, or `calibrate` of a
// tracker, a tip, a camera or a rig.
#pragma once

#include "app/common/module_options.h"
#include "app/common/options.h"
#include "trial/assemble/assemble.h"

namespace enc::app {

// Each is a subcommand: it prints its results, returns the exit code, and throws Error.
struct FitModule {
  int (*fit)(const FitOptions& options) = nullptr;
  int (*shadow)(const ShadowOptions& options) = nullptr;
  int (*tracker)(const TrackerOptions& options) = nullptr;
  int (*tip)(const TipOptions& options) = nullptr;
  // modules: source of vision and the twin's camera, which only pictures need.
  int (*camera)(const CameraOptions& options, const trial::DriverSource& modules) = nullptr;
  int (*rig)(const RigOptions& options, const trial::DriverSource& modules) = nullptr;
};

}  // namespace enc::app
