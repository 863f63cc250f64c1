// What the program finds in encounter_vision.so.
#include "core/devices/module.h"

#include "core/vision/rectified_painter.h"
#include "core/vision/vision_module.h"
#include "core/vision/vision_tracker.h"

namespace {

std::unique_ptr<enc::PoseTracker> tracker(std::unique_ptr<enc::StereoCamera> camera,
                                          const enc::StereoRig& rig, const enc::VisionRig& vision,
                                          enc::Release release) {
  return std::make_unique<enc::VisionTracker>(std::move(camera), rig,
                                              enc::FingerTracker(rig, vision.segmentation, vision.fingertip,
                                                                 vision.track, vision.match, vision.search),
                                              release);
}
std::unique_ptr<enc::AugmentedView> augmented(const enc::AugmentedSpec& spec,
                                              std::span<const enc::Object> objects) {
  return std::make_unique<enc::AugmentedView>(spec, objects);
}
std::unique_ptr<enc::BallFinder> ball(const enc::StereoRig& rig, const enc::BallSpec& spec) {
  return std::make_unique<enc::BallFinder>(rig, spec);
}
std::unique_ptr<enc::SeenPainter> painter(const enc::StereoRig& rig) {
  return std::make_unique<enc::RectifiedPainter>(rig);
}
constexpr enc::VisionModule kVision{
    .tracker = tracker, .augmented = augmented, .painter = painter, .ball = ball};

}  // namespace

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const enc::ModuleInfo kInfo{.name = "vision", .vision = &kVision};
  return &kInfo;
}
