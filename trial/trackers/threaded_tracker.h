// A tracker that works in a thread of its own, such as vision through a real camera: what the haptic loop
// asks of it takes no longer than to hand over the time and to look whether there is news.
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
  // Throws Error (kind device) where there is no thread to be had. The tracker is from now on asked by that
  // thread alone, once for each poll() or, while it works on a frame, for the newest of several: its time is
  // the experiment's, and no clock is read.
  explicit ThreadedTracker(std::unique_ptr<PoseTracker> tracker);
  // Waits for what the thread is at, a frame at most.
  ~ThreadedTracker() override;
  ThreadedTracker(const ThreadedTracker&) = delete;
  ThreadedTracker& operator=(const ThreadedTracker&) = delete;

  // The newest that the thread had when it was last asked; neither waits nor allocates. Older news that
  // nobody has fetched is gone.
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override;
  // False while the tracker says so, and while the thread has not come back for kPatience polls.
  [[nodiscard]] bool linked() const noexcept override;
  // These two wait for the thread: not for the loop.
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] std::vector<std::string> remarks() const override;

  static constexpr std::uint32_t kPatience = 1000;  // a second at 1 kHz

 private:
  // After each time that the tracker was asked.
  struct Word {
    Stamped<TrackedTool> tool;
    std::uint32_t news = 0;   // so far
    std::uint32_t calls = 0;  // that are answered with it
    bool linked = true;
  };
  void work() noexcept;

  std::unique_ptr<PoseTracker> tracker_;
  mutable std::mutex at_work_;  // the thread's while it asks the tracker; the loop never takes it
  Latest<Time> now_;
  Latest<Word> said_;
  std::atomic<std::uint32_t> calls_ = 0;  // of poll(), and of the end
  std::atomic<bool> stop_ = false;
  Word heard_;  // of the loop
  std::uint32_t told_ = 0;
  std::thread thread_;
};

}  // namespace enc::trial
