// The tracker of a scene that names [camera]: vision through the stereo camera of the rig, or of the twin.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/devices/pose_tracker.h"
#include "models/setup/scene_file.h"
#include "sim/world.h"
#include "trial/assemble.h"

namespace enc::trial {

struct VisionOffer {
  const sim::World* world = nullptr;  // of the twin's camera, which sees its hand; outlives the tracker
  std::uint64_t seed = 0;
  Log& log;
  bool waits = false;  // as in Offer
  // Folders (kept_frames.h): its frames are kept there; the rig's camera plays that one. Empty: none.
  std::string keep{}, kept{};
};

// Loads the modules that it takes. Throws Error (kind device) where a module is missing or a device is not
// there, with its place where a number of a file is impossible.
[[nodiscard]] std::unique_ptr<PoseTracker> make_vision(const models::Setup& setup,
                                                       const DriverSource& modules, const VisionOffer& offer);

}  // namespace enc::trial
