// The clock drives the loop: a simulated clock advances its world by one period, a machine's clock waits for
// the cycle.
#pragma once

#include "core/base/time.h"

namespace enc {

// Lag of a wall-time clock, counted from one cycle on.
struct Lateness {
  std::int64_t times = 0;             // number of late ticks
  double total = 0.0, longest = 0.0;  // s
};

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Tick next() = 0;
  // Cycles without a tick since the last next(); the index of that tick is higher by this number. A lockstep
  // clock is never late: 0.
  [[nodiscard]] virtual std::int64_t missed() const noexcept { return 0; }
  // Totals since the start.
  [[nodiscard]] virtual Lateness lateness() const noexcept { return {}; }
};

}  // namespace enc
