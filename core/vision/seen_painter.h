// The results of vision drawn into a pair of images: skin, candidates, fingertip [VisHap Figs 2 and 3].
#pragma once

#include "core/devices/pose_tracker.h"
#include "core/devices/stereo_camera.h"

namespace enc {

struct SeenPair {
  Image left, right;  // rectified
};

class SeenPainter {
 public:
  virtual ~SeenPainter() = default;
  // `frame`: the tracker's last frame. The left image has a green tint on skin within the searched region,
  // and yellow dots on candidates. The fingertip is a red circle, or a grey one if it is doubtful. The images
  // are plain if the tracker is not from this module.
  [[nodiscard]] virtual SeenPair draw(const StereoFrame& frame, const PoseTracker& tracker) const = 0;
};

}  // namespace enc
