// What the program finds in encounter_fit.so.
#include "core/devices/module.h"

#include "app/calibrate/fits/fits.h"
#include "app/fit/commands.h"
#include "app/fit/fit_module.h"

namespace enc::app {
namespace {

int fit_command(const FitOptions& options) { return options.ball ? fit_ball(options) : fit_loop(options); }

constexpr FitModule kFit{.fit = fit_command,
                         .shadow = shadow_command,
                         .tracker = calibrate_tracker,
                         .tip = calibrate_tip,
                         .camera = calibrate_camera,
                         .rig = calibrate_rig};

}  // namespace
}  // namespace enc::app

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const enc::ModuleInfo kInfo{.name = "fit", .fit = &enc::app::kFit};
  return &kInfo;
}
