// What command_line.cpp is made of besides: options that several subcommands share, and a subcommand with
// many.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "app/options.h"

namespace enc::app {

// Checks of CLI11: what is wrong, or nothing.
std::string bad_seed(const std::string& text);
std::string unnamed(const std::string& text);

void force_option(CLI::App* command, bool& force);
void device_options(CLI::App* command, bool& armed, bool& lockstep);
CLI::App* add_calibrate(CLI::App& app, CalibrateOptions& options);
CLI::App* add_shadow(CLI::App& app, ShadowOptions& options);

}  // namespace enc::app
