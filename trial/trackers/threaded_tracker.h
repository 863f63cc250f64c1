// A tracker that works in its own thread, such as vision with a real camera. Also its stand-in in virtual
// time, whose results arrive equally irregularly but repeatably.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/latest.h"
#include "core/devices/device.h"
#include "sim/truth/random.h"

namespace enc::trial {

// The haptic loop only hands over the time and checks for a new result.
class ThreadedTracker final : public PoseTracker {
 public:
  // Throws Error (kind device) if no thread is available. From now on only that thread calls the tracker:
  // once for each poll() or, while it works on a frame, for the newest of several. The tracker's time is the
  // experiment's, and no clock is read.
  explicit ThreadedTracker(std::unique_ptr<PoseTracker> tracker);
  // Waits until the thread has finished its work, one frame at most.
  ~ThreadedTracker() override;
  ThreadedTracker(const ThreadedTracker&) = delete;
  ThreadedTracker& operator=(const ThreadedTracker&) = delete;

  // The newest result of the thread at its last call; neither waits nor allocates. An older result that was
  // not fetched is lost.
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override;
  // False if the tracker reports so, or if the thread has not returned for kPatience polls.
  [[nodiscard]] bool linked() const noexcept override;
  // These two wait for the thread: never call them in the loop.
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] std::vector<std::string> remarks() const override;

  static constexpr std::uint32_t kPatience = 1000;  // a second at 1 kHz

 private:
  // The thread's report after each call of the tracker.
  struct Word {
    Measurement<TrackedTool> tool;
    std::uint32_t news = 0;   // number of results so far
    std::uint32_t calls = 0;  // number of calls answered by it
    bool linked = true;
  };
  void work() noexcept;

  std::unique_ptr<PoseTracker> tracker_;
  // Held by the thread while it calls the tracker; the loop never takes it.
  mutable std::mutex at_work_;
  LatestValue<Time> now_;
  LatestValue<Word> said_;
  std::atomic<std::uint32_t> calls_ = 0;  // calls of poll(), and the end
  std::atomic<bool> stop_ = false;
  Word heard_;  // the loop's copy
  std::uint32_t told_ = 0;
  std::thread thread_;
};

// Results and stamps are unchanged, but each arrives at a random time around its due time.
class JitteredTracker final : public PoseTracker {
 public:
  struct Spec {
    Duration latency{};  // time from the stamp to the due time
    Duration jitter{};   // largest deviation from the due time, either way
    std::uint64_t seed = 1;
  };
  // `tracker` must return its results at the exposure or soon after (its own latency 0), so that a result can
  // arrive before its due time. A result never arrives before the tracker has it, nor before an older one,
  // because a thread works on one after the other.
  JitteredTracker(std::unique_ptr<PoseTracker> tracker, const Spec& spec)
      : tracker_(std::move(tracker)), spec_(spec), draw_(spec.seed, "jitter") {}

  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    if (Measurement<TrackedTool> told; tracker_->poll(now, told) && count_ < line_.size()) {
      const double early_or_late = (2.0 * draw_.uniform() - 1.0) * seconds(spec_.jitter);
      last_ = std::max({last_, now, told.t + spec_.latency + from_seconds(early_or_late)});
      line_[(first_ + count_++) % line_.size()] = {told, last_};
    }
    bool due = false;
    for (; count_ > 0 && line_[first_].due <= now; --count_, due = true) {
      newest = line_[first_].told;
      first_ = (first_ + 1) % line_.size();
    }
    return due;
  }
  [[nodiscard]] std::string describe() const override { return tracker_->describe(); }
  [[nodiscard]] bool linked() const noexcept override { return tracker_->linked(); }
  [[nodiscard]] std::vector<std::string> remarks() const override { return tracker_->remarks(); }

 private:
  struct WaitingSample {
    Measurement<TrackedTool> told;
    Time due{};
  };
  std::unique_ptr<PoseTracker> tracker_;
  Spec spec_;
  sim::Stream draw_;
  std::array<WaitingSample, 64> line_;  // a ring
  std::size_t first_ = 0, count_ = 0;
  Time last_ = Time::min();
};

}  // namespace enc::trial
