// Modules: shared objects beside the program, loaded when a scene, rig or command names them. They stay
// loaded to the end.
#pragma once

#include <string>
#include <vector>

#include "app/common/options.h"
#include "core/devices/module.h"
#include "models/setup/scene_file.h"

namespace enc::app {

// $ENCOUNTER_MODULES, else `modules` beside the program.
[[nodiscard]] std::string modules_dir();
// "view" of "encounter_view.so"; empty: no module's file.
[[nodiscard]] std::string module_name(const std::string& file);
// Names of those that are there ("sample", "view"), in order. Nothing is loaded.
[[nodiscard]] std::vector<std::string> modules_there();
// Whether load_module() would find its file.
[[nodiscard]] bool module_there(const std::string& name);
// Loads encounter_<name>.so. Throws Error (kind device) of one line: which file, what was found and expected,
// what to do, and which modules are there.
[[nodiscard]] const ModuleInfo& load_module(const std::string& name);

// Drivers alone: no other module of the program.
[[nodiscard]] std::vector<std::string> drivers_there();
// With the scene of the tennis ball, where none is named.
[[nodiscard]] SceneOptions with_scene(const SceneOptions& options);
// A set-up with the tables of its drivers read, as far as their modules are there. Throws Error (kind input)
// for a driver that is none, or not for its role.
[[nodiscard]] models::Setup load_setup(const SceneOptions& options);

}  // namespace enc::app
