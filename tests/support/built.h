// What this build made, for tests that run it. Functions and not macros, so that the tests are the same text
// in every preset and a compiler cache knows them again.
#pragma once

#include <string>

namespace enc::tests {

[[nodiscard]] std::string source_dir();  // the project's top folder
[[nodiscard]] std::string program_file();
[[nodiscard]] std::string module_folder();
[[nodiscard]] bool is_built(const std::string& module);  // "vision"

}  // namespace enc::tests
