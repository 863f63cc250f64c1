#include "sim/clock.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace enc::sim {
namespace {

using Wall = std::chrono::steady_clock;

std::int64_t now_ns() { return std::chrono::nanoseconds(Wall::now().time_since_epoch()).count(); }

}  // namespace

void PacedClock::wait_until(std::int64_t due_ns) {
  constexpr std::int64_t kSlice = 50'000'000;  // ns
  for (std::int64_t now = now_ns(); now < due_ns; now = now_ns()) {
    if (stopped_ && stopped_()) return;
    std::this_thread::sleep_until(Wall::time_point(std::chrono::nanoseconds(std::min(due_ns, now + kSlice))));
  }
}

Tick PacedClock::next() {
  Tick tick = clock_->next();
  missed_ = 0;
  if (!started_) {
    started_ = true;
    start_ns_ = now_ns();
    first_ = tick.t;
  }
  // If experiment time is hours and the pace slow, wall time would overflow an integer.
  constexpr double kForEver = 9e17;  // ns
  const double after = std::min(seconds(tick.t - first_) / factor_ * 1e9, kForEver);
  const double period = std::min(seconds(tick.dt) / factor_ * 1e9, kForEver);
  const std::int64_t due = start_ns_ + std::llround(after);
  const std::int64_t late = now_ns() - due;
  if (late < 0) {
    wait_until(due);
  } else if (static_cast<double>(late) >= period) {
    ++lateness_.times;
    lateness_.total += static_cast<double>(late) / 1e9;
    lateness_.longest = std::max(lateness_.longest, static_cast<double>(late) / 1e9);
    if (late_ == LatePolicy::wait) {
      start_ns_ += late;
      return tick;
    }
    missed_ = static_cast<std::int64_t>(static_cast<double>(late) / period);
    for (std::int64_t i = 0; i < missed_ && !(stopped_ && stopped_()); ++i) tick = clock_->next();
  }
  return tick;
}

}  // namespace enc::sim
