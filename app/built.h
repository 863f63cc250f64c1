// What a scene builds and what it leaves out, in words.
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
  std::string what;  // "60 Hz, sim"  or why it is left out
};
[[nodiscard]] std::vector<Part> parts_of(const models::Setup& setup);
// "built: hexapod, force (sim)…" and "left out: camera (not named)…": two lines.
[[nodiscard]] std::string parts_text(const models::Setup& setup);

// What real devices say of themselves, or what keeps them from it: a line each; or nothing.
[[nodiscard]] std::string devices_text(const std::vector<trial::DeviceWords>& devices);

// What a picture names of the parts that a scene may be without; empty: the scene does not have it.
struct SeenParts {
  std::string prop, tool, gripper, force_sensor;
};
[[nodiscard]] SeenParts seen_parts(const SceneSpec& scene);

// How to ask what the scene wants the person to be asked, in one line; or nothing.
[[nodiscard]] std::string questionnaire_text(const models::Setup& setup);

// What was repaired in meshes, a line each on standard error.
void print_notes(const std::vector<std::string>& notes);

// A line for each object that is rendered less deep than it asks, because the machine cannot carry its force;
// or nothing.
[[nodiscard]] std::string weak_text(const models::Setup& setup, const Scene& scene);

}  // namespace enc::app
