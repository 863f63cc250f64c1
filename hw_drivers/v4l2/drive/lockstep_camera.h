// The driver of a fake camera whose time advances with the run. It has neither a thread nor a clock: each
// poll() asks the fake for the frame of its tick, so that a run is the same each time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/devices/driver.h"
#include "hw_drivers/v4l2/drive/capture.h"

namespace enc::v4l2 {

class LockstepCamera final : public StereoCamera {
 public:
  // Opens the devices. Throws Error (kind device).
  LockstepCamera(const Offer& offer, const V4l2Settings& settings, std::unique_ptr<System> system);

  [[nodiscard]] std::string describe() const override { return words_; }
  [[nodiscard]] bool is_fake() const override { return capture_.fake(); }
  [[nodiscard]] bool linked() const noexcept override { return capture_.there(); }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] ImageSize size() const override { return size_; }
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override;

 private:
  std::unique_ptr<System> system_;
  ImageSize size_;
  Capture capture_;
  std::string words_;
  StereoPicture picture_;
};

}  // namespace enc::v4l2
