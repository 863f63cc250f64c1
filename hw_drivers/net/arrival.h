// What time it is by the loop's clock while a tick goes on. A tick whose process was stopped reads what came
// long after it began; taken for as old as the tick, that would seem to come before it was sent.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/time.h"

namespace enc::net {

class Arrival {
 public:
  // keeps_wall_time: the loop's clock does. Else nothing comes later than its tick.
  explicit Arrival(bool keeps_wall_time) : follows_(keeps_wall_time) {}

  // now: of the tick; steady: of steady_now(), when something is read.
  [[nodiscard]] Time at(Time now, Duration steady) noexcept {
    if (!follows_) return now;
    const std::int64_t ahead = steady.count() - now.time_since_epoch().count();
    least_ = std::min(least_, ahead);
    return now + Duration(ahead - least_);
  }

 private:
  bool follows_;
  std::int64_t least_ = std::numeric_limits<std::int64_t>::max();  // ns: between the two clocks
};

}  // namespace enc::net
