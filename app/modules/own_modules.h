// The program's own modules for its subcommands. A module that was not built is refused with the command that
// builds it.
#pragma once

#include <string>

#include "app/calibrate/images/calibration_module.h"
#include "app/fit/fit_module.h"
#include "core/devices/module.h"

namespace enc::app {

const FitModule& fit_module();
const CalibrationModule& calibration_module();
// A module by its name. Vision and the twin's camera are built on the first request for pictures; all other
// names are drivers.
const ModuleInfo& module_for_pictures(const std::string& name);

}  // namespace enc::app
