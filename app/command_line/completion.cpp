#include "app/command_line/completion.h"

#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace enc::app {
namespace {

// The shell's variable with the values of an option; empty: there is none.
std::string_view list_for(const OptionWords& option) {
  const std::string& name = option.names.back();
  if (name == "scene" || name == "--scene") return "$scenes";
  if (name == "rig" || name == "--rig") return "$rigs";
  if (name == "command") return "$commands";
  return name == "form" ? "$forms" : "";
}

// What may follow: words, and files unless `files` is empty.
std::string following(std::string_view words, bool files) {
  return fmt::format("words=\"{}\" files={}", words, files ? "yes" : "");
}

// "--rig) words="$rigs" files=yes ;;" for each option that takes a value.
std::string value_cases(const CommandWords& command) {
  std::string text;
  for (const OptionWords& option : command.options) {
    if (option.positional || !option.takes_value) continue;
    const std::string words = option.choices.empty() ? std::string(list_for(option))
                                                     : fmt::format("{}", fmt::join(option.choices, " "));
    text += fmt::format("        {}) {} ;;\n", fmt::join(option.names, " | "),
                        following(words, option.takes_text));
  }
  return text;
}

std::string command_case(const CommandWords& command) {
  std::vector<std::string> options, operands;
  bool files = false;
  for (const OptionWords& option : command.options) {
    if (!option.positional) {
      options.insert(options.end(), option.names.begin(), option.names.end());
      continue;
    }
    files = files || option.takes_text;
    if (const std::string_view list = list_for(option); !list.empty()) operands.emplace_back(list);
  }
  for (const CommandWords& sub : command.subcommands) operands.push_back(sub.path.back());
  return fmt::format(
      "    \"{}\")\n"
      "      if [[ $word == -* ]]; then {}; else {}; fi\n"
      "      case $before in\n{}      esac ;;\n",
      fmt::join(command.path, "/"), following(fmt::format("{}", fmt::join(options, " ")), false),
      following(fmt::format("{}", fmt::join(operands, " ")), files), value_cases(command));
}

// Every command with those below it, from the program down.
void flatten(const CommandWords& command, std::vector<const CommandWords*>& all) {
  all.push_back(&command);
  for (const CommandWords& sub : command.subcommands) flatten(sub, all);
}

constexpr std::string_view kHead =
    R"(# Completion of encounter for bash, written by `encounter help --bash`.
_encounter() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command="" words="" files="" i
  # The shell splits --rig=sim into three words.
  if [[ $word == "=" ]]; then word=""; elif [[ $before == "=" ]]; then before=${COMP_WORDS[COMP_CWORD - 2]}; fi
)";
constexpr std::string_view kTail =
    R"(  COMPREPLY=()
  [[ -z $words ]] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  if [[ -n $files ]]; then
    local found
    mapfile -t found < <(compgen -f -- "$word")
    COMPREPLY+=("${found[@]}")
    compopt -o filenames 2>/dev/null
  fi
}
complete -F _encounter encounter
)";

}  // namespace

std::string bash_completion(const CommandWords& program, const ShippedNames& shipped) {
  std::vector<const CommandWords*> all;
  flatten(program, all);
  std::vector<std::string> paths, commands;
  std::string cases;
  for (const CommandWords* command : all) {
    cases += command_case(*command);
    if (command->path.size() == 1) commands.push_back(command->path.front());
    if (command->path.size() == 1) paths.push_back("/" + command->path.front());
    if (command->path.size() > 1) paths.push_back(fmt::format("{}", fmt::join(command->path, "/")));
  }
  const auto list = [](const char* name, const std::vector<std::string>& names) {
    return fmt::format("  local {}=\"{}\"\n", name, fmt::join(names, " "));
  };
  return std::string(kHead) + list("scenes", shipped.scenes) + list("rigs", shipped.rigs) +
         list("forms", shipped.forms) + list("commands", commands) +
         fmt::format(
             "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
             "    case \"$command/${{COMP_WORDS[i]}}\" in\n"
             "      {}) command=${{command:+$command/}}${{COMP_WORDS[i]}} ;;\n"
             "    esac\n"
             "  done\n"
             "  case $command in\n{}  esac\n",
             fmt::join(paths, " | "), cases) +
         std::string(kTail);
}

}  // namespace enc::app
