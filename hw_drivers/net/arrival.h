// What time it is by the loop's clock while a tick goes on. A tick whose process was stopped reads what came
// long after it began; taken for as old as the tick, that would seem to come before it was sent.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/base/time.h"

namespace enc::net {

class Arrival {
 public:
  // keeps_wall_time: the loop's clock does. Else nothing comes later than its tick.
  explicit Arrival(bool keeps_wall_time) : follows_(keeps_wall_time) {}

  // In each tick, before of(). now: of the tick; steady: steady_now().
  void begin(Time now, Duration steady) noexcept {
    least_ = std::min(least_, steady.count() - now.time_since_epoch().count());
  }
  // By the loop's clock, when it was that by steady_now().
  [[nodiscard]] Time of(Time now, Duration steady) const noexcept {
    return follows_ ? Time(Duration(steady.count() - least_)) : now;
  }

 private:
  bool follows_;
  std::int64_t least_ = std::numeric_limits<std::int64_t>::max();  // ns: between the two clocks
};

}  // namespace enc::net
