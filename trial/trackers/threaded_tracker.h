// A tracker that works in its own thread, such as vision with a real camera. The haptic loop only hands over
// the time and checks for a new result.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/base/latest.h"
#include "core/devices/pose_tracker.h"

namespace enc::trial {

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
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override;
  // False if the tracker reports so, or if the thread has not returned for kPatience polls.
  [[nodiscard]] bool linked() const noexcept override;
  // These two wait for the thread: never call them in the loop.
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] std::vector<std::string> remarks() const override;

  static constexpr std::uint32_t kPatience = 1000;  // a second at 1 kHz

 private:
  // The thread's report after each call of the tracker.
  struct Word {
    Stamped<TrackedTool> tool;
    std::uint32_t news = 0;   // number of results so far
    std::uint32_t calls = 0;  // number of calls answered by it
    bool linked = true;
  };
  void work() noexcept;

  std::unique_ptr<PoseTracker> tracker_;
  // Held by the thread while it calls the tracker; the loop never takes it.
  mutable std::mutex at_work_;
  Latest<Time> now_;
  Latest<Word> said_;
  std::atomic<std::uint32_t> calls_ = 0;  // calls of poll(), and the end
  std::atomic<bool> stop_ = false;
  Word heard_;  // the loop's copy
  std::uint32_t told_ = 0;
  std::thread thread_;
};

}  // namespace enc::trial
