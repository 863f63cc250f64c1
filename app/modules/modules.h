// Modules: shared objects beside the program, loaded when a scene, rig or command names them. They stay
// loaded until the end.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/calibrate/images/calibration_module.h"
#include "app/common/options.h"
#include "app/fit/fit_module.h"
#include "app/live/live_module.h"
#include "core/devices/module.h"
#include "models/setup/scene_file.h"

namespace enc::app {

// $ENCOUNTER_MODULES if set, else `modules` beside the program.
[[nodiscard]] std::string modules_dir();
// Returns "view" for "encounter_view.so"; empty: not a module's file.
[[nodiscard]] std::string module_name(const std::string& file);
// Names of the available modules ("sample", "view"), in order. Loads no module.
[[nodiscard]] std::vector<std::string> modules_there();
// True if load_module() would find its file.
[[nodiscard]] bool module_there(const std::string& name);
// Loads encounter_<name>.so. Throws Error (kind device) of one line: the file, the problem, the expectation,
// the remedy, and the available modules.
[[nodiscard]] const ModuleInfo& load_module(const std::string& name);

// The available drivers, without the other modules of the program.
[[nodiscard]] std::vector<std::string> drivers_there();
// "press" for each encounter_bench_press.so: benchmarks of somebody else. Loads no module.
[[nodiscard]] std::vector<std::string> benchmarks_there();
// Returns the options. If they name no scene, it is the tennis ball, or the wall for a rig with an arm.
[[nodiscard]] SceneOptions with_scene(const SceneOptions& options);
// A set-up with the tables of its drivers read, as far as their modules are available. Throws Error (kind
// input) for an unknown driver, or one that does not fill its role.
[[nodiscard]] models::Setup load_setup(const SceneOptions& options);

// Checks that the file of a module is complete. The loader maps the sizes in its header, and reading beyond
// the end of a truncated file ends the program (SIGBUS).
// head: from the file's start to the end of its segment table. Returns the reason why the file is incomplete;
// empty: complete, or not a 64-bit library, which the loader reports itself.
[[nodiscard]] std::string cut_off(std::string_view head, std::uint64_t size);
[[nodiscard]] std::string cut_off(const std::string& path);

// The program's own modules for its subcommands. A module that was not built is refused with the command that
// builds it.
const FitModule& fit_module();
const LiveModule& live_module();
const CalibrationModule& calibration_module();
// A module by its name. Vision and the twin's camera are built on the first request for pictures; all other
// names are drivers.
const ModuleInfo& module_for_pictures(const std::string& name);

}  // namespace enc::app
