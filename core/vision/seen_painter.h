// What vision made of a pair of images, drawn into them: skin, candidates, fingertip [VisHap Figs 2 and 3].
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
  // `frame`: the one that the tracker saw last. In the left image skin is tinted green where the tracker
  // looked for it, and candidates are yellow dots. The fingertip is a red circle, a grey one where it is not
  // believed. The images are plain where the tracker is none of this module.
  [[nodiscard]] virtual SeenPair draw(const StereoFrame& frame, const PoseTracker& tracker) const = 0;
};

}  // namespace enc
