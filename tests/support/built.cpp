#include "tests/support/built.h"

namespace enc::tests {

std::string program_file() { return ENCOUNTER_BINARY; }
std::string module_folder() { return ENCOUNTER_MODULE_DIR; }

}  // namespace enc::tests
