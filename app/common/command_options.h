// Options that several subcommands share.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "app/common/options.h"

namespace enc::app {

// Checks for CLI11: return the problem, or an empty text.
std::string bad_seed(const std::string& text);
std::string unnamed(const std::string& text);
// Of a file or folder to write. "-" is refused: it would be a file of that name, while the report goes to
// standard output.
std::string bad_output(const std::string& text);

// A subcommand whose help begins with a sentence and ends with an example, "run tennis_ball".
CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& sentence,
                      const std::string& example);

void force_option(CLI::App* command, bool& force);
void json_option(CLI::App* command, bool& json);
// The options of a command that may move real devices: armed, lockstep, yes, not_real_time.
template <class Options>
void device_options(CLI::App* command, Options& options) {
  command->add_flag(
      "--armed", options.armed,
      "send commands to the devices, so that a real machine moves; default: only read the devices");
  command->add_flag(
      "--lockstep", options.lockstep,
      "run against `encounter fake --lockstep`: each set-point advances time by one period, so runs are "
      "fast and repeatable");
  command->add_flag("--yes", options.yes, "skip the question before the first motion of an armed run");
  command->add_flag("--not-real-time", options.not_real_time,
                    "arm a real machine even if the system denies the loop real-time priority");
}
void scene_options(CLI::App* command, SceneOptions& options);

}  // namespace enc::app
