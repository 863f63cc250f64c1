// The device: a stereo camera that plays a folder of images or a video.
#pragma once

#include "core/devices/driver.h"
#include "hw_drivers/images/play/playback.h"

namespace enc::images {

class ImageCamera final : public StereoCamera {
 public:
  // Throws Error (kind device). `log` must outlive this. `waits`: the run waits for a late frame.
  ImageCamera(const Reel& reel, Log& log, bool waits);

  [[nodiscard]] std::string describe() const override { return words_; }
  [[nodiscard]] bool linked() const noexcept override {
    return playback_->state() == Playback::State::playing;
  }
  [[nodiscard]] ImageSize size() const override { return size_; }
  // Frame n has the time n / rate after the first poll. The end or a stall (stale) and a damaged file (fault)
  // are reported once, with the last frame and its time.
  bool poll(Time now, Stamped<StereoFrame>& newest) noexcept override;

 private:
  std::string words_;
  ImageSize size_;
  Playback::State told_ = Playback::State::playing;
  std::unique_ptr<Playback> playback_;
};

}  // namespace enc::images
