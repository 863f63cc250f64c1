// The frames of a stereo camera as a folder of images, each named by the nanosecond of its exposure:
// left/50000000.png and right/50000000.png. Kept while a run goes on, shown again at the same times.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/time.h"
#include "core/devices/stereo_camera.h"
#include "core/vision/frame_files.h"
#include "models/files.h"

namespace enc::trial {

// Passes on what a camera gives, and writes it down.
class KeepingCamera final : public StereoCamera {
 public:
  // Throws Error where the folder cannot be made or holds frames already.
  KeepingCamera(std::unique_ptr<StereoCamera> camera, const std::string& folder, const FrameFiles& files);
  ~KeepingCamera() override;  // without a frame the folders are taken away again, where they are empty
  KeepingCamera(const KeepingCamera&) = delete;
  KeepingCamera& operator=(const KeepingCamera&) = delete;

  bool poll(Time now, Stamped<StereoFrame>& newest) noexcept override;
  [[nodiscard]] bool linked() const noexcept override { return camera_->linked(); }
  [[nodiscard]] ImageSize size() const override { return camera_->size(); }
  [[nodiscard]] std::string describe() const override { return camera_->describe(); }
  // Those of the camera, and why no more frames were kept.
  [[nodiscard]] std::vector<std::string> remarks() const override;

 private:
  std::unique_ptr<StereoCamera> camera_;
  std::string path_;
  bool made_;  // by this run
  models::OutFolder folder_, left_, right_;
  const FrameFiles& files_;
  std::string failure_;
};

// When the frames of such a folder were exposed, in order. Throws Error where it holds none, or others.
[[nodiscard]] std::vector<Time> exposures_in(const std::string& folder);

// A camera that plays such a folder frame by frame, at the times of their exposures.
class KeptCamera final : public StereoCamera {
 public:
  static constexpr double kRate = 20.0;  // Hz, at which `camera` plays: its own time is not asked

  // `camera` plays the folder's pairs in order.
  KeptCamera(std::unique_ptr<StereoCamera> camera, std::vector<Time> exposed)
      : camera_(std::move(camera)), exposed_(std::move(exposed)) {}

  bool poll(Time now, Stamped<StereoFrame>& newest) noexcept override;
  [[nodiscard]] ImageSize size() const override { return camera_->size(); }
  [[nodiscard]] std::string describe() const override { return camera_->describe(); }
  [[nodiscard]] std::size_t frames() const { return exposed_.size(); }

 private:
  std::unique_ptr<StereoCamera> camera_;
  std::vector<Time> exposed_;  // in order
  Every played_{kRate, 0, {}};
};

}  // namespace enc::trial
