// Modules: shared objects beside the program, loaded when a scene, rig or command names them. They stay
// loaded to the end.
#pragma once

#include <string>
#include <vector>

#include "core/module.h"

namespace enc::app {

// $ENCOUNTER_MODULES, else `modules` beside the program.
[[nodiscard]] std::string modules_dir();
// Names of those that are there ("sample", "view"), in order. Nothing is loaded.
[[nodiscard]] std::vector<std::string> modules_there();
// Whether load_module() would find its file.
[[nodiscard]] bool module_there(const std::string& name);
// Loads encounter_<name>.so. Throws Error (kind device) of one line: which file, what was found and expected,
// what to do, and which modules are there.
[[nodiscard]] const ModuleInfo& load_module(const std::string& name);

}  // namespace enc::app
