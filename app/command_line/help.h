// How help is printed, and `encounter help`: help, the manual page, and completion for a shell.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace enc::app {

// Help within 80 columns.
class Help final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

// Adds `help`, which describes all commands of the app, later ones too.
void add_help(CLI::App& app);

}  // namespace enc::app
