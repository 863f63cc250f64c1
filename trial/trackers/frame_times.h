// Arrival of vision's frames at the haptic loop: rate, jitter and age of the results, in the experiment's
// time, with a resolution of one tick.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/sample.h"
#include "trial/lists/room.h"

namespace enc::trial {

struct FrameTimes {
  bool threaded = false;  // vision runs in its own thread, not within the loop
  std::int64_t frames = 0;
  std::vector<double> intervals, ages;  // s: between two hand-overs, and from exposure to hand-over
  Time first{}, last{};                 // hand-over

  // Reserves memory beforehand: the loop allocates nothing, and frames beyond the first million are only
  // counted.
  void reserve(double expected) {
    const auto most = static_cast<std::size_t>(std::min(2.0 * expected + 16.0, 1e6));
    intervals = with_room<double>(most);
    ages = with_room<double>(most);
  }
  // Call this after each reading of the tracker. A repeated result, such as a stale one, is not a frame.
  void see(Time now, const Measurement<TrackedTool>& newest) noexcept {
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
