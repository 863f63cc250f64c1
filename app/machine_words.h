// The words in which a hexapod and an arm differ, chosen once for a scene.
#pragma once

#include <cstddef>

#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"

namespace enc::app {

struct MachineWords {
  std::size_t row;        // of the machine in tables of functions
  const char* tip;        // what the machine moves, and whence its place is known
  const char* tracked;    // what the tracker follows
  const char* tool;       // what meets the objects, in a picture
  const char* met;        // what does not happen in an empty contact
  const char* section;    // of the rig file, with the machine's law
  const char* law;        // what the law gives
  const char* held_back;  // by the passivity controller
  const char* energy_by;  // what measures the energy of a contact
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
  return scene.arm ? kArm : kHexapod;
}

}  // namespace enc::app
