// A stereo camera that plays a folder of images or a video.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "core/base/time.h"
#include "core/devices/driver.h"
#include "hw_drivers/images/play/frame_source.h"

namespace enc::images {

// Plays a source at a rate. One thread reads ahead, so that the loop never waits for a file. Another thread
// reports events, because the first may hang in a file.
//
// The due frame depends only on the time: equal frames come at equal times in every run, at any speed. A run
// without a wall clock (`--pace free`) waits for a frame that is due but not read yet. So it can be repeated
// to the bit. A run on the wall clock never waits: it reports the late frame instead.
class Playback {
 public:
  enum class State : std::uint8_t { playing, stalled, ended, failed };
  using Say = std::function<void(const std::string&)>;  // called in a separate thread

  // Waits for the first frame; throws the source's Error. Frame n has the time n / rate after the first
  // take(). `waits`: the run waits, for at most kLongestWait of wall time.
  Playback(std::unique_ptr<FrameSource> source, double rate, Say say, bool waits);
  ~Playback();
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  // Goes to the newest due frame; returns false if that is the present one.
  bool take(Time now) noexcept;
  // The present frame, valid until the next take().
  [[nodiscard]] const ImagePair& frame() const { return slots_[slot(frames_.n - 1)]; }
  [[nodiscard]] Time exposed() const { return exposed_; }
  [[nodiscard]] State state() const { return state_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::int64_t kSlots = 4;
  static constexpr std::chrono::seconds kLongestWait{10};
  static std::size_t slot(std::int64_t frame) { return static_cast<std::size_t>(frame % kSlots); }

  void read_ahead();
  bool read(std::int64_t frame);        // false: no more frames
  [[nodiscard]] bool there() noexcept;  // true if the next due frame is read
  void tell();                          // reports events to the user
  void wake() noexcept;

  std::unique_ptr<FrameSource> source_;
  std::string words_;
  Say say_;
  bool waits_;
  std::array<ImagePair, kSlots> slots_;
  std::string error_;  // written before over_
  // Frames read and taken; the last one taken is in use.
  std::atomic<int> read_ = 0, taken_ = 0;
  std::atomic<int> calls_ = 0;  // wakes the threads
  std::atomic<bool> over_ = false, stop_ = false;
  std::atomic<int> late_ = -1;  // the first frame that was not ready in time
  std::atomic<State> state_ = State::playing;

  // Data of the caller of take().
  DueTimes frames_;
  bool begun_ = false;
  Time exposed_{};
  std::thread reader_, teller_;
};

// The device: a stereo camera that plays a folder of images or a video.
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
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override;

 private:
  std::string words_;
  ImageSize size_;
  Playback::State told_ = Playback::State::playing;
  std::unique_ptr<Playback> playback_;
};

}  // namespace enc::images
