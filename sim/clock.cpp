#include "sim/clock.h"

#include <chrono>
#include <thread>

namespace enc::sim {

Tick Paced::next() {
  using Wall = std::chrono::steady_clock;
  const Tick tick = clock_->next();
  if (!started_) {
    started_ = true;
    start_ns_ = std::chrono::nanoseconds(Wall::now().time_since_epoch()).count();
    first_ = tick.t;
  }
  const Duration due = from_seconds(seconds(tick.t - first_) / factor_);
  std::this_thread::sleep_until(Wall::time_point(std::chrono::nanoseconds(start_ns_ + due.count())));
  return tick;
}

}  // namespace enc::sim
