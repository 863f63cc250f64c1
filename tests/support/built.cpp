#include "tests/support/built.h"

#include <cstdlib>
#include <filesystem>

namespace enc::tests {

std::string source_dir() { return ENCOUNTER_SOURCE_DIR; }
std::string program_file() { return ENCOUNTER_BINARY; }
std::string module_folder() { return ENCOUNTER_MODULE_DIR; }
int thorough(int few, int all) { return std::getenv("ENCOUNTER_ALL_SEEDS") != nullptr ? all : few; }
bool is_built(const std::string& module) {
  return std::filesystem::exists(module_folder() + "/encounter_" + module + ".so");
}

}  // namespace enc::tests
