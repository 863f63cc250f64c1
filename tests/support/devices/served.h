// A fake that a thread serves on the wall clock, as `encounter fake` does.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "core/devices/fake.h"
#include "hw_drivers/net/steady.h"

namespace enc::test {

class Served {
 public:
  explicit Served(Fake& fake) : fake_(fake) {}
  ~Served() { end(); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;
  void end() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  Fake& fake_;
  std::atomic<bool> end_ = false;
  std::thread thread_{[this] {
    while (!end_) {
      const Time now(net::steady_now());
      fake_.serve(now);
      fake_.publish(now);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }};
};

}  // namespace enc::test
