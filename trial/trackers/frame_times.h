// When the haptic loop heard of the frames of vision: its rate, its jitter and how old its results are. In
// the experiment's time, of which a tick is the least.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/sample.h"
#include "trial/lists/room.h"

namespace enc::trial {

struct FrameTimes {
  bool threaded = false;  // vision is in a thread of its own, not within the loop
  std::int64_t frames = 0;
  std::vector<double> intervals, ages;  // s: from one hand-over to the next, and of each since the exposure
  Time first{}, last{};                 // hand-over

  // Beforehand: nothing is allocated within the loop, and what is beyond the first million is only counted.
  void reserve(double expected) {
    const auto most = static_cast<std::size_t>(std::min(2.0 * expected + 16.0, 1e6));
    intervals = with_room<double>(most);
    ages = with_room<double>(most);
  }
  // After each reading of the tracker. What is told again, as stale, is no frame.
  void see(Time now, const Stamped<TrackedTool>& newest) noexcept {
    if (newest.health == Health::absent || (frames > 0 && newest.t == exposed_)) return;
    if (frames == 0) first = now;
    if (frames > 0 && intervals.size() < intervals.capacity()) intervals.push_back(age(now, last));
    if (ages.size() < ages.capacity()) ages.push_back(age(now, newest.t));
    last = now;
    exposed_ = newest.t;
    ++frames;
  }
  [[nodiscard]] double rate() const {  // Hz
    return frames > 1 ? static_cast<double>(frames - 1) / age(last, first) : kUnset;
  }

 private:
  Time exposed_{};
};

}  // namespace enc::trial
