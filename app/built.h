// The parts that a scene builds and leaves out, as text, and the words for its machine.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"
#include "sim/spec/twin_spec.h"
#include "trial/assemble/assemble.h"

namespace enc::app {

// Words that differ between a hexapod and an arm, chosen once for a scene.
struct MachineWords {
  std::size_t row;        // row of the machine in tables of functions
  const char* tip;        // the machine's moving part, and the source of its position
  const char* tracked;    // the tracked part
  const char* tool;       // the part that touches the objects, in a picture
  const char* met;        // word for a real contact
  const char* section;    // section of the rig file with the machine's law
  const char* law;        // quantity that the machine's law gives
  const char* held_back;  // quantity that the passivity controller limits
  const char* energy_by;  // instrument that measures the energy of a contact
  PassivityForm (*passivity)(const RigSpec& rig);
};

[[nodiscard]] inline const MachineWords& words_of(const SceneSpec& scene) {
  static constexpr MachineWords kHexapod{
      .row = 0,
      .tip = "haptic-tip, from the machine's joints",
      .tracked = "tool markers, from the tracker",
      .tool = "hand-held tool with markers",
      .met = "felt",
      .section = "admittance",
      .law = "way",
      .held_back = "tip",
      .energy_by = "the machine's own force and pose",
      .passivity = [](const RigSpec& rig) { return rig.admittance.passivity; }};
  static constexpr MachineWords kArm{.row = 1,
                                     .tip = "tip, from the arm's joints",
                                     .tracked = "finger, from the tracker",
                                     .tool = "finger",
                                     .met = "touched",
                                     .section = "arm",
                                     .law = "force",
                                     .held_back = "law's force",
                                     .energy_by = "encoders",
                                     .passivity = [](const RigSpec& rig) { return rig.arm.passivity; }};
  return *sim::PerMachine<const MachineWords*>{&kHexapod, &kArm}.of(scene);
}

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

// One line for each object that is rendered less deep than its file asks, because the machine cannot carry
// its force; or empty.
[[nodiscard]] std::string weak_text(const models::Setup& setup, const Scene& scene);

}  // namespace enc::app
