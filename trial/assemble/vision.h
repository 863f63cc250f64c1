// The tracker of a scene with [camera]: vision with the stereo camera of the rig or of the twin.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/devices/device.h"
#include "core/machine/arm_shape.h"
#include "models/setup/scene_file.h"
#include "sim/camera/camera_scene.h"
#include "sim/camera/stage.h"
#include "sim/world.h"
#include "trial/assemble/assemble.h"

namespace enc::trial {

// An arm's parts for the twin's camera: grey and blue metal, far from the hue of skin.
[[nodiscard]] inline sim::Rgb colour_of(Material material) {
  switch (material) {
    case Material::metal:
      return {0.25F, 0.26F, 0.28F};
    case Material::dark:
      return {0.08F, 0.085F, 0.095F};
    case Material::painted:
      return {0.10F, 0.14F, 0.22F};
    case Material::plate:
      break;
  }
  return {0.60F, 0.62F, 0.64F};
}

[[nodiscard]] inline sim::Thing thing_of(const ArmPart& part, const Pose<'C', 'W'>& X_CW) {
  const sim::ThingShape shape = part.form == PartForm::capsule    ? sim::ThingShape::capsule
                                : part.form == PartForm::cylinder ? sim::ThingShape::cylinder
                                                                  : sim::ThingShape::box;
  return {shape, X_CW * part.middle, X_CW.q().toRotationMatrix() * part.axes, part.half,
          colour_of(part.material)};
}

// Receives each new pair of images before the tracker does.
using Look = std::function<void(const Measurement<StereoFrame>&)>;

struct VisionOffer {
  const sim::World* world = nullptr;  // the twin, whose hand its camera sees; outlives the tracker
  std::uint64_t seed = 0;
  Log& log;
  bool waits = false, lockstep = false;  // as in Offer
  bool threaded = false;  // vision runs in its own thread, and the twin's camera draws in another
  Look look{};            // as in TrialOptions; may be empty
  // Folders (kept_frames.h): `keep` receives the frames; the rig's camera plays `kept`. Empty: unused.
  std::string keep{}, kept{};
};

// The twin's true camera and its surroundings, by seed, as drawn for this stereo head.
[[nodiscard]] sim::StageSpec stage_of(const sim::CameraTruth& truth, std::uint64_t seed);

// Loads the needed modules. Throws Error (kind device) if a module or a device is missing, or Error with its
// place if a number of a file is impossible.
[[nodiscard]] std::unique_ptr<PoseTracker> make_vision(const models::Setup& setup,
                                                       const DriverSource& modules, const VisionOffer& offer);

// The twin's camera for fakes (drawn_camera.h). `world` outlives it. Throws Error as make_vision() does.
[[nodiscard]] std::unique_ptr<StereoCamera> make_drawn_camera(const models::Setup& setup,
                                                              const DriverSource& modules,
                                                              const sim::World& world, std::uint64_t seed,
                                                              bool waits);

}  // namespace enc::trial
