// The painter of the vision module (seen_painter.h).
#pragma once

#include "core/vision/seen_painter.h"
#include "core/vision/stereo/rectify.h"
#include "core/vision/vision_tracker.h"

namespace enc {

class RectifiedPainter final : public SeenPainter {
 public:
  explicit RectifiedPainter(const StereoRig& rig) : rectifier_(rig) {}
  [[nodiscard]] SeenPair draw(const StereoFrame& frame, const PoseTracker& tracker) const override;

 private:
  Rectifier rectifier_;
};

}  // namespace enc
