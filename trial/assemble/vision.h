// The tracker of a scene that names [camera]: vision through the stereo camera of the rig, or of the twin.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/devices/pose_tracker.h"
#include "core/devices/stereo_camera.h"
#include "models/setup/scene_file.h"
#include "sim/camera/stage.h"
#include "sim/world.h"
#include "trial/assemble/assemble.h"

namespace enc::trial {

// The true camera of the twin, and what it looks at; by seed.
[[nodiscard]] sim::StageSpec stage_of(const sim::CameraTruth& truth, std::uint64_t seed);

// Is shown each pair of images that comes, before the tracker.
using Look = std::function<void(const Stamped<StereoFrame>&)>;

struct VisionOffer {
  const sim::World* world = nullptr;  // of the twin's camera, which sees its hand; outlives the tracker
  std::uint64_t seed = 0;
  Log& log;
  bool waits = false;     // as in Offer
  bool threaded = false;  // in a thread of its own: not through the twin's camera, whose world is the loop's
  Look look{};            // as in TrialOptions; may be empty
  // Folders (kept_frames.h): its frames are kept there; the rig's camera plays that one. Empty: none.
  std::string keep{}, kept{};
};

// What the twin's cameras are drawn with: the true head.
[[nodiscard]] sim::StageSpec stage_of(const sim::CameraTruth& truth, std::uint64_t seed);

// Loads the modules that it takes. Throws Error (kind device) where a module is missing or a device is not
// there, with its place where a number of a file is impossible.
[[nodiscard]] std::unique_ptr<PoseTracker> make_vision(const models::Setup& setup,
                                                       const DriverSource& modules, const VisionOffer& offer);

}  // namespace enc::trial
