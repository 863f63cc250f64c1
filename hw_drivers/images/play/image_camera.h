// The device: a stereo camera that plays a folder of images or a video.
#pragma once

#include "core/devices/driver.h"
#include "hw_drivers/images/play/playback.h"

namespace enc::images {

class ImageCamera final : public StereoCamera {
 public:
  // Throws Error (kind device). `log` stays as long as this. `waits`: the run does, where a frame is late.
  ImageCamera(const Reel& reel, Log& log, bool waits);

  [[nodiscard]] std::string describe() const override { return words_; }
  [[nodiscard]] bool linked() const noexcept override {
    return playback_->state() == Playback::State::playing;
  }
  [[nodiscard]] ImageSize size() const override { return size_; }
  // Frame n is of n / rate after the first poll. The end and a stall (stale) and a damaged file (fault) are
  // told once, with the last frame and its time.
  bool poll(Time now, Stamped<StereoFrame>& newest) noexcept override;

 private:
  std::string words_;
  ImageSize size_;
  Playback::State told_ = Playback::State::playing;
  std::unique_ptr<Playback> playback_;
};

}  // namespace enc::images
