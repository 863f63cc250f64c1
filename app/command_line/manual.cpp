#include "app/command_line/manual.h"

#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

namespace enc::app {
namespace {

// Text that groff prints as it is. A dash stays a dash that a shell accepts.
std::string plain(const std::string& text) {
  std::string escaped = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte >= 0xC0) {  // the first byte of a character beyond ASCII (UTF-8)
      std::uint32_t code = byte & (byte >= 0xF0 ? 0x07U : byte >= 0xE0 ? 0x0FU : 0x1FU);
      for (; i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xC0U) == 0x80U; ++i)
        code = code << 6U | (static_cast<unsigned char>(text[i + 1]) & 0x3FU);
      escaped += fmt::format("\\[u{:04X}]", code);
    } else if (byte == '\\') {
      escaped += "\\e";
    } else if (byte == '-') {
      escaped += "\\-";
    } else if (byte == '\'' || byte == '`' || byte == '^' || byte == '~') {  // groff prints others for these
      escaped += byte == '\'' ? "\\(aq" : byte == '`' ? "\\(ga" : byte == '^' ? "\\(ha" : "\\(ti";
    } else {
      escaped += static_cast<char>(byte);
    }
  }
  return escaped;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fP"; }
std::string italic(const std::string& text) { return "\\fI" + plain(text) + "\\fP"; }

std::string entry(const std::string& head, const std::string& text) {
  return ".TP\n" + head + "\n" + plain(text) + "\n";
}

std::string options_of(const CommandWords& command) {
  std::string text;
  for (const OptionWords& option : command.options)
    text += entry((option.positional ? italic(option.shown) : bold(option.shown)) +
                      (option.value.empty() ? "" : " " + plain(option.value)),
                  option.meaning);
  return text;
}

std::string synopsis(const CommandWords& command) {
  std::string line = bold(full_name(command)) + " [" + italic("options") + "]";
  for (const OptionWords& option : command.options)
    if (option.positional) line += " " + italic(option.shown);
  if (!command.subcommands.empty()) line += " " + italic("subcommand") + " ...";
  return line;
}

// A section for each subcommand; those below it follow.
std::string sections(const CommandWords& command) {
  std::string text;
  for (const CommandWords& sub : command.subcommands) {
    text += fmt::format(".SS {}\n{}\n.PP\n{}\n", plain(full_name(sub)), plain(sub.sentence), synopsis(sub));
    text += options_of(sub);
    if (!sub.example.empty()) text += ".PP\nExample: " + bold(sub.example) + "\n";
    text += sections(sub);
  }
  return text;
}

using Row = std::pair<const char*, const char*>;
template <std::size_t N>
std::string entries(const char* section, const std::array<Row, N>& rows) {
  std::string text = fmt::format(".SH {}\n", section);
  for (const auto& [head, meaning] : rows) text += entry(bold(head), meaning);
  return text;
}

constexpr std::array<Row, 6> kExit{
    {{"0", "The answer is yes."},
     {"1", "The answer is no: a figure out of bounds, a replay that differs, a run that crossed a limit."},
     {"2", "The command or a file is wrong."},
     {"3", "A device failed."},
     {"4", "The run ended in hold, or its physics diverged."},
     {"129, 130, 131, 143",
      "SIGHUP, SIGINT, SIGQUIT or SIGTERM: the run stops what moves, and ends with its report."}}};
constexpr std::array<Row, 2> kEnvironment{
    {{"ENCOUNTER_MODELS", "Folder of scenes, rigs, responses and meshes, in place of the shipped one."},
     {"ENCOUNTER_MODULES",
      "Folder of modules, in place of modules/ beside the program: drivers, and benchmarks of your own."}}};

}  // namespace

std::string manual_page(const CommandWords& program, const std::string& version, const std::string& day) {
  return fmt::format(".TH ENCOUNTER 1 \"{}\" \"Encounter {}\" \"User Commands\"\n", plain(day),
                     plain(version)) +
         ".SH NAME\nencounter \\- a digital twin of encounter\\-type haptic displays\n" + ".SH SYNOPSIS\n" +
         synopsis(program) + "\n" + ".SH DESCRIPTION\n" +
         plain(
             "Encounter simulates machines that carry a surface to the place where a hand, or a tool in it, "
             "is about to touch, and runs them over real devices.") +
         "\n.SH OPTIONS\n" + options_of(program) + ".SH SUBCOMMANDS\n" + sections(program) +
         entries("EXIT STATUS", kExit) + entries("ENVIRONMENT", kEnvironment);
}

}  // namespace enc::app
