// The frames of a stereo camera as a folder of images, each named by the nanosecond of its exposure:
// left/50000000.png and right/50000000.png. A run can save them, and a later run replays them at the same
// times.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/time.h"
#include "core/devices/device.h"
#include "core/devices/module.h"
#include "models/files.h"

namespace enc::trial {

// Passes on a camera's frames and saves them.
class KeepingCamera final : public StereoCamera {
 public:
  // Throws Error if it cannot create the folder, or if the folder already holds frames.
  KeepingCamera(std::unique_ptr<StereoCamera> camera, const std::string& folder, const FrameFiles& files);
  ~KeepingCamera() override;  // without a frame, removes the folders if they are empty
  KeepingCamera(const KeepingCamera&) = delete;
  KeepingCamera& operator=(const KeepingCamera&) = delete;

  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override;
  [[nodiscard]] bool linked() const noexcept override { return camera_->linked(); }
  [[nodiscard]] ImageSize size() const override { return camera_->size(); }
  [[nodiscard]] std::string describe() const override { return camera_->describe(); }
  // The camera's remarks, and the reason why saving stopped.
  [[nodiscard]] std::vector<std::string> remarks() const override;

 private:
  std::unique_ptr<StereoCamera> camera_;
  std::string path_;
  bool made_;  // this run created the folder
  models::OutFolder folder_, left_, right_;
  const FrameFiles& files_;
  std::string failure_;
};

// Exposure times of a folder's frames, in order. Throws Error if the folder has no frames, or other files.
[[nodiscard]] std::vector<Time> exposures_in(const std::string& folder);

// A camera that replays such a folder frame by frame, at the times of exposure.
class KeptCamera final : public StereoCamera {
 public:
  static constexpr double kRate = 20.0;  // Hz, playback rate of `camera`, whose own time is unused

  // `camera` plays the folder's pairs in order.
  KeptCamera(std::unique_ptr<StereoCamera> camera, std::vector<Time> exposed)
      : camera_(std::move(camera)), exposed_(std::move(exposed)) {}

  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override;
  [[nodiscard]] ImageSize size() const override { return camera_->size(); }
  [[nodiscard]] std::string describe() const override { return camera_->describe(); }
  [[nodiscard]] std::size_t frames() const { return exposed_.size(); }

 private:
  std::unique_ptr<StereoCamera> camera_;
  std::vector<Time> exposed_;  // in order
  DueTimes played_{kRate, 0, {}};
};

}  // namespace enc::trial
