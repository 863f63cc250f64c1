// The parts that a scene builds and leaves out, as text.
#pragma once

#include <string>
#include <vector>

#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/assemble.h"

namespace enc::app {

struct Part {
  std::string name;  // "display"
  bool built = false;
  std::string what;  // "60 Hz, sim", or the reason for leaving it out
};
[[nodiscard]] std::vector<Part> parts_of(const models::Setup& setup);
// "built: hexapod, force (sim)…" and "left out: camera (not named)…": two lines.
[[nodiscard]] std::string parts_text(const models::Setup& setup);

// The real devices' own descriptions, or the errors that prevent them, one line each; or empty.
[[nodiscard]] std::string devices_text(const std::vector<trial::DeviceWords>& devices);

// Names in a picture for the parts that a scene may lack; empty: the scene lacks it.
struct SeenParts {
  std::string prop, tool, gripper, force_sensor;
};
[[nodiscard]] SeenParts seen_parts(const SceneSpec& scene);

// Command that starts the scene's questionnaire for the person, in one line; or empty.
[[nodiscard]] std::string questionnaire_text(const models::Setup& setup);

// Prints repairs of meshes, one line each, on standard error.
void print_notes(const std::vector<std::string>& notes);

// One line for each object rendered less deep than it asks, because the machine cannot carry its force; or
// empty.
[[nodiscard]] std::string weak_text(const models::Setup& setup, const Scene& scene);

}  // namespace enc::app
