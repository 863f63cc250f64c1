// The environment of the tests: the parts of this build, the project's folder, how thorough to be. Functions
// instead of macros keep the tests' text equal in every preset, so that a compiler cache recognises them.
#pragma once

#include <string>

namespace enc::tests {

[[nodiscard]] std::string source_dir();  // the project's top folder
[[nodiscard]] std::string program_file();
[[nodiscard]] std::string module_folder();
[[nodiscard]] bool is_built(const std::string& module);  // "vision"
// Number of repetitions of a property with another seed: `few` times in ./check, `all` in ./check --full,
// which sets ENCOUNTER_ALL_SEEDS.
[[nodiscard]] int thorough(int few, int all);

}  // namespace enc::tests
