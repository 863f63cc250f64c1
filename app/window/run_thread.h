// The thread of all runs of a window. It is made before the window's thread lowers its priority, because
// threads inherit a lower priority and cannot raise it again.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace enc::app {

class RunThread {
 public:
  RunThread() : thread_([this] { work(); }) {}
  ~RunThread() {
    tell(nullptr, true);
    thread_.join();
  }
  RunThread(const RunThread&) = delete;
  RunThread& operator=(const RunThread&) = delete;

  void begin(std::function<void()> run) { tell(std::move(run), false); }  // after wait()
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !run_; });
  }

 private:
  void tell(std::function<void()> run, bool ends) {
    const std::lock_guard lock(mutex_);
    run_ = std::move(run);
    ends_ = ends;
    changed_.notify_all();
  }
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return ends_ || run_; });
      if (ends_) return;
      lock.unlock();
      run_();
      lock.lock();
      run_ = nullptr;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> run_;  // unset: no work
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace enc::app
