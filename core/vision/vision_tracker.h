// A stereo camera and vision as a tracker of a bare fingertip. It tells places; how the finger is turned is
// not seen, so that the tool's axes are those of C and its origin is the middle of the cap.
#pragma once

#include <array>
#include <memory>

#include "core/devices/pose_tracker.h"
#include "core/vision/finger_tracker.h"
#include "core/vision/vision_module.h"

namespace enc {

class VisionTracker : public PoseTracker {
 public:
  static constexpr std::int32_t kFinger = 0;  // the index that a finger's tool has in a scene

  // Throws Error where rate or latency are impossible, or the camera's images are not as large as the rig
  // says.
  VisionTracker(std::unique_ptr<StereoCamera> camera, const StereoRig& rig, FingerTracker tracker,
                Release release = Release::when_due);

  // A place when the frame's exposure is `latency` ago, or at once, stamped with the exposure; a frame with a
  // stamp that is still to come is not believed. A frame that shows no
  // finger gives no tool (-1), and so does one from which the place is only foreseen: the core foresees by
  // itself, and its judgement of age must see that the finger is lost. When frames stay out for three periods
  // longer than they take, once more the last place, Health::stale.
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override;
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool linked() const noexcept override { return camera_->linked(); }
  // A background that was not learned, a finger in it or in no frame at all, frames that could not be used,
  // finds that were doubtful; and the camera's own.
  [[nodiscard]] std::vector<std::string> remarks() const override;

  // What the newest poll() that said true is about: with velocity and covariance.
  [[nodiscard]] const Finger& finger() const { return told_; }
  [[nodiscard]] const FingerTracker& tracker() const { return tracker_; }

 private:
  void take(Time now, const Stamped<StereoFrame>& frame);
  bool stalled(Time now, Stamped<TrackedTool>& newest);

  std::unique_ptr<StereoCamera> camera_;
  FingerTracker tracker_;
  Duration wait_{}, patience_{};  // after an exposure: for its place, and for the next
  std::array<Finger, 64> line_;   // places that are not due yet, a ring
  std::size_t first_ = 0, count_ = 0;
  Finger told_;
  Stamped<TrackedTool> last_;
  Stamped<StereoFrame> frame_;
  bool said_stale_ = false;
  std::array<int, kWords<Refused>.size()> refused_{};  // frames
  std::array<int, kWords<Doubt>.size()> doubtful_{};   // frames
  int background_ = 0, looked_ = 0, seen_ = 0;         // frames; seen: that showed a finger
};

}  // namespace enc
