// The numbers of vision: rig table [vision].
#pragma once

#include "core/base/image.h"
#include "core/spec/vision/ball_spec.h"
#include "core/spec/vision/finger_spec.h"
#include "core/spec/vision/match_spec.h"
#include "core/spec/vision/segmentation_spec.h"

namespace enc {

struct VisionRig {
  SegmentationSpec segmentation;
  FingertipSpec fingertip;
  TrackSpec track;
  MatchSpec match;
  BallSpec ball;  // of the registration through the images
  // px of the rectified left image, in which a finger that is not tracked is sought; empty: everywhere. One
  // that is tracked may leave it.
  Region search;
};

}  // namespace enc
