#include "app/command_line/help.h"

#include <algorithm>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/command_line/command_words.h"
#include "app/command_line/completion.h"
#include "app/command_line/manual.h"
#include "app/common/command_options.h"
#include "core/base/error.h"
#include "encounter_version.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "models/setup/scene_names.h"
#include "trial/provenance/provenance.h"

namespace enc::app {
namespace {

// A line of help, broken at 80 columns; the rest stands under the first word of its column.
std::string wrapped_line(const std::string& line) {
  constexpr std::size_t kWidth = 80, kColumn = 30;  // CLI11's column of descriptions
  const std::size_t start = line.find_first_not_of(' ');
  if (line.size() <= kWidth || start == std::string::npos) return line + "\n";
  const bool described =
      start > 0 && line.size() > kColumn && line[kColumn] != ' ' && line[kColumn - 1] == ' ';
  const std::size_t indent = described ? kColumn : start;
  const std::size_t space = line.rfind(' ', kWidth);
  if (space == std::string::npos || space <= indent) return line + "\n";
  return line.substr(0, space) + "\n" + wrapped_line(std::string(indent, ' ') + line.substr(space + 1));
}

struct HelpOptions {
  std::vector<std::string> command;
  bool manual = false, bash = false;
};

// The subcommand that the words name. Throws Error for an unknown word.
const CLI::App& named_command(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* at = &app;
  for (const std::string& word : words) {
    std::vector<std::string> names;
    for (const CLI::App* command : at->get_subcommands({})) names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), word) == names.end())
      throw Error("unknown subcommand " + models::quoted(word) + "; " + models::advice(word, names));
    at = at->get_subcommand(word);
  }
  return *at;
}

void print_help(const CLI::App& app, const HelpOptions& options) {
  if (options.manual) {
    const trial::BuiltCommit commit = trial::built_commit();
    fmt::print("{}", manual_page(command_words(app), ENCOUNTER_VERSION, commit.day));
  } else if (options.bash) {
    const std::string models = models::models_dir();
    fmt::print("{}",
               bash_completion(command_words(app), {.scenes = models::scene_names(models),
                                                    .rigs = models::files_in(models, "rigs"),
                                                    .forms = models::files_in(models, "questionnaires")}));
  } else {
    const CLI::App& command = named_command(app, options.command);
    std::string before = "encounter";
    for (const std::string& word : options.command) before += " " + word;
    fmt::print("{}", command.get_formatter()->make_help(&command, before, CLI::AppFormatMode::Normal));
  }
}

}  // namespace

std::string Help::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  std::istringstream lines(CLI::Formatter::make_help(app, std::move(name), mode));
  std::string text;
  for (std::string line; std::getline(lines, line);) text += wrapped_line(line);
  return text;
}

void add_help(CLI::App& app) {
  const auto options = std::make_shared<HelpOptions>();
  CLI::App* command =
      add_command(app, "help", "Print help, the manual page, or completion for a shell.", "help run");
  command->add_option("command", options->command, "subcommand to explain; none: all of them");
  CLI::Option* manual =
      command->add_flag("--man", options->manual, "the manual page instead: encounter help --man | man -l -");
  command
      ->add_flag("--bash", options->bash,
                 "completion for bash instead: add `source <(encounter help --bash)` to ~/.bashrc")
      ->excludes(manual);
  command->callback([&app, options] { print_help(app, *options); });
}

}  // namespace enc::app
