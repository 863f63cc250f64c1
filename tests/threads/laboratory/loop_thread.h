// A loop of 1 kHz in a thread of its own. What is seen of it from outside orders nothing between threads: a
// test that waited for it otherwise would hide from ThreadSanitizer what it is there to find.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "hw_drivers/net/steady.h"

namespace enc::test {

// Until something holds; false where it does not in a minute.
template <class What>
bool comes_true(const What& what) {
  for (int i = 0; i < 60'000 && !what(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return what();
}

template <class Ticks>
class LoopThread {
 public:
  // ticks.tick(now): of the loop's thread.
  explicit LoopThread(Ticks& ticks) : ticks_(ticks), thread_([this] { run(); }) {}
  ~LoopThread() { end(); }
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  void end() {
    over_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
  }
  // Returns when it has made so many more.
  void pass(std::int64_t ticks) const {
    const std::int64_t until = made() + ticks;
    static_cast<void>(comes_true([&] { return made() >= until; }));
  }
  [[nodiscard]] std::int64_t made() const { return made_.load(std::memory_order_relaxed); }

 private:
  void run() {
    for (const Duration begun = net::steady_now(); !over_.load(std::memory_order_relaxed);) {
      ticks_.tick(Time(net::steady_now() - begun));
      made_.fetch_add(1, std::memory_order_relaxed);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  Ticks& ticks_;
  std::atomic<bool> over_ = false;
  std::atomic<std::int64_t> made_ = 0;
  std::thread thread_;
};

}  // namespace enc::test
