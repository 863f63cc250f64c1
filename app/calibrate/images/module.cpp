// Entry point of encounter_calibration.so.
#include "core/devices/module.h"

#include <encounter_version.h>
#include <fmt/format.h>

#include "app/calibrate/images/calibration_module.h"
#include "app/calibrate/images/commands.h"
#include "models/schema/wording.h"

namespace enc::app {
namespace {

constexpr CalibrationModule kCalibration{.stereo = calibrate_stereo, .skin = calibrate_skin};

}  // namespace

std::string made_by(const std::string& command) {
  return models::printable(
             fmt::format("# Encounter {}: ./encounter calibrate {}", ENCOUNTER_VERSION, command)) +
         "\n";
}

}  // namespace enc::app

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const enc::ModuleInfo kInfo{.name = "calibration", .calibration = &enc::app::kCalibration};
  return &kInfo;
}
