// Fakes that a thread of their own serves on the wall clock. What they suffer is done to them on that thread
// between two turns, as `encounter fake` does it: a fake is for one thread.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/net/steady.h"

namespace enc::test {

inline constexpr std::array<Trouble::Kind, 11> kAllTroubles{
    Trouble::Kind::loss,     Trouble::Kind::jitter,     Trouble::Kind::reorder,   Trouble::Kind::duplicate,
    Trouble::Kind::stall,    Trouble::Kind::disconnect, Trouble::Kind::garbage,   Trouble::Kind::half_message,
    Trouble::Kind::saturate, Trouble::Kind::error_code, Trouble::Kind::slow_start};

class FaultyFakes {
 public:
  explicit FaultyFakes(std::vector<Fake*> fakes) : fakes_(std::move(fakes)) {}
  ~FaultyFakes() { end(); }
  FaultyFakes(const FaultyFakes&) = delete;
  FaultyFakes& operator=(const FaultyFakes&) = delete;

  // These return when it is done, and are for one other thread.
  void suffer(Fake& fake, const Trouble& trouble) {
    between_turns([&] { fake.suffer(trouble); });
  }
  void heal(Fake& fake, Trouble::Kind kind) {
    between_turns([&] { fake.heal(kind); });
  }
  void heal(Fake& fake) {
    between_turns([&] {
      for (const Trouble::Kind kind : kAllTroubles)
        if (fake.knows({kind})) fake.heal(kind);
    });
  }
  // From then on nobody serves them, as where the program is stopped.
  void end() {
    over_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  void between_turns(const std::function<void()>& work) {
    std::unique_lock lock(mutex_);
    work_ = &work;
    done_.wait(lock, [this] { return work_ == nullptr; });
  }
  void work() {
    const std::lock_guard lock(mutex_);
    if (work_ == nullptr) return;
    (*work_)();
    work_ = nullptr;
    done_.notify_one();
  }
  void serve() {
    while (!over_) {
      work();
      const Time now(net::steady_now());
      for (Fake* const fake : fakes_) fake->serve(now);
      for (Fake* const fake : fakes_) fake->publish(now);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }

  std::vector<Fake*> fakes_;
  std::atomic<bool> over_ = false;
  std::mutex mutex_;
  std::condition_variable done_;
  const std::function<void()>* work_ = nullptr;  // under the mutex
  std::thread thread_{[this] { serve(); }};
};

}  // namespace enc::test
