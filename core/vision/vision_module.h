// The module encounter_vision: what a scene without a camera never loads.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/devices/pose_tracker.h"
#include "core/devices/stereo_camera.h"
#include "core/spec/vision/stereo_rig.h"
#include "core/spec/vision/vision_rig.h"
#include "core/vision/augment/augmented_view.h"
#include "core/vision/ball/ball_finder.h"
#include "core/vision/seen_painter.h"

namespace enc {

// When a place is told.
enum class Release : std::uint8_t {
  when_due,  // the rig's latency after the exposure, however long the work took: the same in every run
  when_done  // in wall time, as soon as it is there
};

struct VisionModule {
  // A tracker of a bare fingertip that looks through the camera. Throws Error where the numbers are
  // impossible.
  std::unique_ptr<PoseTracker> (*tracker)(std::unique_ptr<StereoCamera> camera, const StereoRig& rig,
                                          const VisionRig& vision, Release release) = nullptr;
  // As AugmentedView's constructor.
  std::unique_ptr<AugmentedView> (*augmented)(const AugmentedSpec& spec,
                                              std::span<const Object> objects) = nullptr;
  // Of what its trackers saw through such a camera.
  std::unique_ptr<SeenPainter> (*painter)(const StereoRig& rig) = nullptr;
  // Of the ball at the arm's tip, with the head as it is believed. Throws Error likewise.
  std::unique_ptr<BallFinder> (*ball)(const StereoRig& rig, const BallSpec& ball) = nullptr;
};

}  // namespace enc
