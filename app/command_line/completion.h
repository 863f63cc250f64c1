// Completion of a shell: subcommands, options and their values, and names of shipped files.
#pragma once

#include <string>
#include <vector>

#include "app/command_line/command_words.h"

namespace enc::app {

// Names that complete an option or a positional called "scene", "rig" or "form".
struct ShippedNames {
  std::vector<std::string> scenes, rigs, forms;
};

// A script for bash.
[[nodiscard]] std::string bash_completion(const CommandWords& program, const ShippedNames& shipped);

}  // namespace enc::app
