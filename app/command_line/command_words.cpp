#include "app/command_line/command_words.h"

#include <string_view>

namespace enc::app {
namespace {

// {"raw", "removed"} for "TEXT:{raw,removed}", which CLI11 makes from CLI::IsMember.
std::vector<std::string> choices_in(std::string_view type) {
  const std::size_t from = type.find('{'), to = type.find('}');
  std::vector<std::string> choices;
  if (from == std::string_view::npos || to == std::string_view::npos) return choices;
  std::string_view rest = type.substr(from + 1, to - from - 1);
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    choices.emplace_back(rest.substr(0, comma));
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  }
  return choices;
}

OptionWords option_words(const CLI::Option& option) {
  static const CLI::Formatter kFormat;
  OptionWords words;
  words.positional = option.get_positional();
  words.shown = kFormat.make_option_name(&option, words.positional);
  words.value = kFormat.make_option_opts(&option);
  words.value.erase(0, words.value.find_first_not_of(' '));
  words.meaning = option.get_description();
  words.takes_value = option.get_items_expected_max() > 0;
  words.takes_text = words.takes_value && option.get_type_name() == "TEXT";
  words.choices = choices_in(option.get_type_name());
  if (words.positional) {
    words.names.push_back(words.shown);
  } else {
    for (const std::string& name : option.get_snames()) words.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) words.names.push_back("--" + name);
  }
  return words;
}

CommandWords words_at(const CLI::App& app, const std::vector<std::string>& path) {
  CommandWords words{path, app.get_description(), app.get_footer(), {}, {}};
  if (const std::size_t colon = words.example.find(": "); colon != std::string::npos)
    words.example.erase(0, colon + 2);  // "Example: "
  for (const CLI::Option* option : app.get_options()) words.options.push_back(option_words(*option));
  for (const CLI::App* command : app.get_subcommands({})) {
    std::vector<std::string> below = path;
    below.push_back(command->get_name());
    words.subcommands.push_back(words_at(*command, below));
  }
  return words;
}

}  // namespace

CommandWords command_words(const CLI::App& app) { return words_at(app, {}); }

std::string full_name(const CommandWords& command) {
  std::string name = "encounter";
  for (const std::string& part : command.path) name += " " + part;
  return name;
}

}  // namespace enc::app
