// The window without a scene: the shipped scenes with a picture and a line each, to choose one.
#pragma once

#include <optional>
#include <string>

#include "sim/window/window.h"

namespace enc::app {

// The name of the chosen scene; unset: the window was closed. Pictures are made while it is shown.
[[nodiscard]] std::optional<std::string> choose_scene(sim::ViewWindow& window);

}  // namespace enc::app
