// Modules: shared objects beside the program, loaded when a scene, rig or command names them. They stay
// loaded until the end.
#pragma once

#include <string>
#include <vector>

#include "app/common/options.h"
#include "core/devices/module.h"
#include "models/setup/scene_file.h"

namespace enc::app {

// $ENCOUNTER_MODULES, else `modules` beside the program.
[[nodiscard]] std::string modules_dir();
// "view" for "encounter_view.so"; empty: not a module's file.
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
// The options with the scene of the tennis ball if they name no scene.
[[nodiscard]] SceneOptions with_scene(const SceneOptions& options);
// A set-up with the tables of its drivers read, as far as their modules are available. Throws Error (kind
// input) for an unknown driver, or one that does not fill its role.
[[nodiscard]] models::Setup load_setup(const SceneOptions& options);

}  // namespace enc::app
