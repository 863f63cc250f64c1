// The window without a scene: a choice of the shipped scenes, each with a picture and a line.
#pragma once

#include <optional>
#include <string>

#include "sim/window/window.h"

namespace enc::app {

// The name of the chosen scene; unset: the window was closed. Pictures are made while the page is shown.
[[nodiscard]] std::optional<std::string> choose_scene(sim::ViewWindow& window);

}  // namespace enc::app
