// The subcommands and options of the command line as plain words. Help, manual page and completion say the
// same, because all of them come from one table (command_line.cpp).
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace enc::app {

struct OptionWords {
  std::vector<std::string> names;  // "-h", "--help"; a positional has one, without dashes
  std::string shown;               // "-h,--help", as --help prints it
  std::string value;               // "TEXT=free", as --help prints it; empty: a flag
  std::string meaning;
  std::vector<std::string> choices;  // the only values; empty: any
  bool positional = false;
  bool takes_value = false;
  bool takes_text = false;  // a value that may be the name of a file
};

struct CommandWords {
  std::vector<std::string> path;  // {"calibrate", "tip"}; empty: the program
  std::string sentence, example;  // "Run a scene and report what happened.", "encounter run tennis_ball"
  std::vector<OptionWords> options;
  std::vector<CommandWords> subcommands;
};

[[nodiscard]] CommandWords command_words(const CLI::App& app);
// The name of a command in the shell: "encounter calibrate tip".
[[nodiscard]] std::string full_name(const CommandWords& command);

}  // namespace enc::app
