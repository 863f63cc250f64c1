// Entry point of encounter_fit.so.
#include "core/devices/module.h"

#include <fmt/format.h>

#include "app/common/words.h"
#include "app/fit/commands.h"
#include "app/fit/fit_module.h"
#include "core/base/error.h"
#include "models/identify/camera/register.h"
#include "models/identify/tip/pivot_log.h"

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

void refuse_pairs(const std::string& csv, const std::string& file, const std::string& expected) {
  if (!models::is_point_set(csv)) return;
  throw Error(
      fmt::format("{}:1:1: is a table of pairs of points; expected {}; run: encounter calibrate camera {}",
                  file, expected, shell_word(file)));
}

void refuse_poses(const std::string& csv, const std::string& file, const std::string& expected) {
  if (!models::is_pivot_log(csv)) return;
  throw Error(
      fmt::format("{}:1:1: is a table of a tool's poses; expected {}; run: encounter calibrate tip {}", file,
                  expected, shell_word(file)));
}

bool is_rig(const std::string& what) {
  return what.find_first_of("./") == std::string::npos || what.ends_with(".toml");
}

}  // namespace enc::app

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const enc::ModuleInfo kInfo{.name = "fit", .fit = &enc::app::kFit};
  return &kInfo;
}
