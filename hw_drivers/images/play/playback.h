// Plays a source at a rate. A thread reads ahead, so that nobody waits for a file in the loop; another says
// what happened, because the first may hang in a file.
//
// Which frame is due follows from the time alone: run by run the same frames come at the same times, however
// fast it runs. A run that keeps no wall clock (`--pace free`) waits for a frame that is due but not read
// yet, so that it can be repeated to the bit; one on the wall clock never waits: there the frame is late,
// which is said.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "core/base/time.h"
#include "hw_drivers/images/play/frame_source.h"

namespace enc::images {

class Playback {
 public:
  enum class State : std::uint8_t { playing, stalled, ended, failed };
  using Say = std::function<void(const std::string&)>;  // called in a thread of its own

  // Waits for the first frame; throws the source's Error. Frame n is of n / rate after the first take().
  // `waits`: the run does, for at most kLongestWait of wall time.
  Playback(std::unique_ptr<FrameSource> source, double rate, Say say, bool waits);
  ~Playback();
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  // Goes to the newest frame that is due; false where that is the one it has.
  bool take(Time now) noexcept;
  // Of the frame that it has, which stays until the next take().
  [[nodiscard]] const ImagePair& frame() const { return slots_[slot(frames_.n - 1)]; }
  [[nodiscard]] Time exposed() const { return exposed_; }
  [[nodiscard]] State state() const { return state_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::int64_t kSlots = 4;
  static constexpr std::chrono::seconds kLongestWait{10};
  static std::size_t slot(std::int64_t frame) { return static_cast<std::size_t>(frame % kSlots); }

  void read_ahead();
  bool read(std::int64_t frame);        // false: no more
  [[nodiscard]] bool there() noexcept;  // the frame that is due next
  void tell();                          // what happened, to a person
  void wake() noexcept;

  std::unique_ptr<FrameSource> source_;
  std::string words_;
  Say say_;
  bool waits_;
  std::array<ImagePair, kSlots> slots_;
  std::string error_;                      // written before over_
  std::atomic<int> read_ = 0, taken_ = 0;  // frames; of those taken the last is in use
  std::atomic<int> calls_ = 0;             // to wake the threads
  std::atomic<bool> over_ = false, stop_ = false;
  std::atomic<int> late_ = -1;  // the first frame that was not there in time
  std::atomic<State> state_ = State::playing;

  // Of whoever takes.
  Every frames_;
  bool begun_ = false;
  Time exposed_{};
  std::thread reader_, teller_;
};

}  // namespace enc::images
