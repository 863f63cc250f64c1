#include "app/common/command_options.h"

#include <cstdint>
#include <string>

#include "models/tables/number_text.h"

namespace enc::app {

// Checked here, because CLI11 reads "-1" and numbers of 30 digits as some other number.
std::string bad_seed(const std::string& text) {
  if (models::number_in<std::uint64_t>(text)) return {};
  return "expected a whole number from 0 to 18446744073709551615";
}

// A script passes "" if its variable is not set.
std::string unnamed(const std::string& text) {
  return text.empty() ? "expected a name, and this one is empty" : std::string();
}

std::string bad_output(const std::string& text) {
  return text == "-" ? "'-' is no name of a file; expected one; choose one" : unnamed(text);
}

CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& sentence,
                      const std::string& example) {
  CLI::App* command = parent.add_subcommand(name, sentence);
  command->footer("Example: encounter " + example);
  return command;
}

void force_option(CLI::App* command, bool& force) {
  command->add_flag("--force", force, "replace existing files");
}

void json_option(CLI::App* command, bool& json) {
  command->add_flag("--json", json, "print one JSON object instead of text");
}

void scene_options(CLI::App* command, SceneOptions& options) {
  command->add_option("scene", options.scene, "scene file, or the name of a shipped scene (encounter scenes)")
      ->required();
  command->add_option("--rig", options.rig, "rig: sim, a name in models/rigs, or a file")
      ->capture_default_str();
  command->add_option("--set", options.set,
                      "override, e.g. object.ball.radius_mm=30 (names: encounter params SCENE)");
  command->add_option("--seed", options.seed, "seed of all random streams")
      ->capture_default_str()
      ->check(bad_seed);
}

}  // namespace enc::app
