// What tests know of where they run: what this build made, the project's folder, how thorough they are.
// Functions and not macros, so that the tests are the same text in every preset and a compiler cache knows
// them again.
#pragma once

#include <string>

namespace enc::tests {

[[nodiscard]] std::string source_dir();  // the project's top folder
[[nodiscard]] std::string program_file();
[[nodiscard]] std::string module_folder();
[[nodiscard]] bool is_built(const std::string& module);  // "vision"
// How often a property is repeated with another seed: `few` times in ./check, `all` in ./check --full, which
// sets ENCOUNTER_ALL_SEEDS.
[[nodiscard]] int thorough(int few, int all);

}  // namespace enc::tests
