// A stereo camera and vision as a tracker of a bare fingertip. It measures only positions, not the finger's
// orientation, so the tool's axes are those of C and its origin is the middle of the cap.
#pragma once

#include <array>
#include <memory>

#include "core/devices/device.h"
#include "core/vision/finger_tracker.h"
#include "core/vision/vision_module.h"

namespace enc {

class VisionTracker : public PoseTracker {
 public:
  static constexpr std::int32_t kFinger = 0;  // index of a finger's tool in a scene

  // Throws Error if rate or latency are impossible, or if the camera's images differ in size from the rig
  // file.
  VisionTracker(std::unique_ptr<StereoCamera> camera, const StereoRig& rig, FingerTracker tracker,
                Release release = Release::when_due);

  // Returns a position once the frame's exposure is `latency` ago, or at once, stamped with the exposure. A
  // frame with a stamp in the future is refused. A frame without a finger gives no tool (-1), and so does a
  // frame with only a predicted position: the core predicts by itself, and its check of the age must detect
  // that the finger is lost. If frames are missing for three periods more than the latency, the last position
  // is returned once more with Health::stale.
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override;
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool linked() const noexcept override { return camera_->linked(); }
  // Remarks: a background that was not learned, a finger in it or in no frame at all, unusable frames,
  // doubtful detections; and the camera's own remarks.
  [[nodiscard]] std::vector<std::string> remarks() const override;

  // The finger of the newest poll() that returned true, with velocity and covariance.
  [[nodiscard]] const Finger& finger() const { return told_; }
  [[nodiscard]] const FingerTracker& tracker() const { return tracker_; }

 private:
  void take(Time now, const Measurement<StereoFrame>& frame);
  bool stalled(Time now, Measurement<TrackedTool>& newest);

  std::unique_ptr<StereoCamera> camera_;
  FingerTracker tracker_;
  // After an exposure: wait for its position, and for the next frame.
  Duration wait_{}, patience_{};
  std::array<Finger, 64> line_;  // positions that are not due yet, a ring
  std::size_t first_ = 0, count_ = 0;
  Finger told_;
  Measurement<TrackedTool> last_;
  Measurement<StereoFrame> frame_;
  bool said_stale_ = false;
  std::array<int, kWords<FrameRefusal>.size()> refused_{};  // frames
  std::array<int, kWords<Doubt>.size()> doubtful_{};        // frames
  int background_ = 0, looked_ = 0, seen_ = 0;              // frames; seen: with a finger
};

}  // namespace enc
