// The module encounter_vision: what a scene without a camera never loads.
#pragma once

#include <memory>

#include "core/devices/pose_tracker.h"
#include "core/devices/stereo_camera.h"
#include "core/devices/stereo_rig.h"
#include "core/vision/ball/ball_finder.h"
#include "core/vision/rig/vision_rig.h"

namespace enc {

struct VisionModule {
  // A tracker of a bare fingertip that looks through the camera. Throws Error where the numbers are
  // impossible.
  std::unique_ptr<PoseTracker> (*tracker)(std::unique_ptr<StereoCamera> camera, const StereoRig& rig,
                                          const VisionRig& vision) = nullptr;
  // Of the ball at the arm's tip, with the head as it is believed. Throws Error likewise.
  std::unique_ptr<BallFinder> (*ball)(const StereoRig& rig, const BallSpec& ball) = nullptr;
};

}  // namespace enc
