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
  BallSpec ball;  // ball for the registration through the images
  // Search region for an untracked finger, px of the rectified left image; empty: everywhere. A tracked
  // finger may leave it.
  Region search;
};

}  // namespace enc
