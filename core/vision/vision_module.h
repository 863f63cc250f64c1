// The module encounter_vision, which a scene without a camera never loads.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/devices/device.h"
#include "core/spec/optics_rig.h"
#include "core/spec/vision_rig.h"
#include "core/vision/augment/augmented_view.h"
#include "core/vision/ball/ball_finder.h"

namespace enc {

struct SeenPair {
  Image left, right;  // rectified
};

// The results of vision drawn into a pair of images: skin, candidates, fingertip [VisHap Figs 2 and 3].
class SeenPainter {
 public:
  virtual ~SeenPainter() = default;
  // `frame`: the tracker's last frame. The left image has a green tint on skin within the searched region,
  // and yellow dots on candidates. The fingertip is a red circle, or a grey one if it is doubtful. The images
  // are plain if the tracker is not from this module.
  [[nodiscard]] virtual SeenPair draw(const StereoFrame& frame, const PoseTracker& tracker) const = 0;
};

// Time at which a position is released.
enum class Release : std::uint8_t {
  // The rig's latency after the exposure, however long the computation took: equal in every run.
  when_due,
  when_done  // in wall time, as soon as it is computed
};

struct VisionModule {
  // A tracker of a bare fingertip that uses the camera. Throws Error if the numbers are impossible.
  std::unique_ptr<PoseTracker> (*tracker)(std::unique_ptr<StereoCamera> camera, const StereoRig& rig,
                                          const VisionRig& vision, Release release) = nullptr;
  // Arguments as for AugmentedView's constructor.
  std::unique_ptr<AugmentedView> (*augmented)(const AugmentedSpec& spec,
                                              std::span<const Object> objects) = nullptr;
  // A painter for the results of the module's trackers with such a camera.
  std::unique_ptr<SeenPainter> (*painter)(const StereoRig& rig) = nullptr;
  // A finder of the ball at the arm's tip, with the rig's model of the head. Throws Error if the numbers are
  // impossible.
  std::unique_ptr<BallFinder> (*ball)(const StereoRig& rig, const BallSpec& ball) = nullptr;
};

}  // namespace enc
