// Subcommands with many options, which command_line.cpp adds.
#pragma once

#include <CLI/CLI.hpp>

#include "app/common/options.h"

namespace enc::app {

CLI::App* add_view(CLI::App& app, ViewOptions& options);
CLI::App* add_tour(CLI::App& app, TourOptions& options);
CLI::App* add_shadow(CLI::App& app, ShadowOptions& options);

}  // namespace enc::app
