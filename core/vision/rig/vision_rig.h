// The numbers of vision: rig table [vision].
#pragma once

#include "core/vision/ball/ball_spec.h"
#include "core/vision/finger/finger_spec.h"
#include "core/vision/image.h"
#include "core/vision/segmentation/segmentation_spec.h"
#include "core/vision/stereo/match_spec.h"

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
