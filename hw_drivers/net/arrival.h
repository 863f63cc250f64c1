// Converts arrival times to the loop's clock within a tick. If the process was stopped, a tick reads data
// that came long after its begin; with the time of the tick, such data would seem to arrive before they were
// sent.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/base/time.h"

namespace enc::net {

class Arrival {
 public:
  // keeps_wall_time: the loop's clock follows wall time. Otherwise no data come later than their tick.
  explicit Arrival(bool keeps_wall_time) : follows_(keeps_wall_time) {}

  // Call in each tick, before of(). now: time of the tick; steady: steady_now().
  void begin(Time now, Duration steady) noexcept {
    least_ = std::min(least_, steady.count() - now.time_since_epoch().count());
  }
  // Time by the loop's clock for a time by steady_now().
  [[nodiscard]] Time of(Time now, Duration steady) const noexcept {
    return follows_ ? Time(Duration(steady.count() - least_)) : now;
  }

 private:
  bool follows_;
  std::int64_t least_ = std::numeric_limits<std::int64_t>::max();  // ns, between the two clocks
};

}  // namespace enc::net
