// Runs the program as a person would, for tests of what it prints and how it ends.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/support/built.h"

namespace enc::tests {

struct Result {
  int code = -1;         // exit code; 128 + signal if one ended it; -1 if it could not be started
  std::string out, err;  // all that it wrote
  double seconds = 0.0;  // from start to end
};

using Environment = std::vector<std::pair<std::string, std::string>>;

// Where the models are that the program is shipped with, wherever it is started.
inline const Environment kShipped{{"ENCOUNTER_MODELS", tests::source_dir() + "/models"}};
inline std::string shipped_scene(const std::string& name) {
  return tests::source_dir() + "/models/scenes/" + name + ".toml";
}

// Another program, which is looked for in PATH. It is killed (code 137) after `timeout` seconds.
Result run(const std::vector<std::string>& command, const Environment& environment = {},
           double timeout = 60.0);

// program_file() with these arguments, with `environment` on top of ours.
Result run_program(const std::vector<std::string>& args, const Environment& environment = {},
                   double timeout = 60.0);

}  // namespace enc::tests
