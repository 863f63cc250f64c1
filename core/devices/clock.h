// Who owns time owns the loop. A simulated clock advances its world by one period; a machine's waits for the
// cycle.
#pragma once

#include "core/base/time.h"

namespace enc {

// How far a clock that keeps wall time fell behind it, by a cycle or more.
struct Lateness {
  std::int64_t times = 0;             // on how many ticks
  double total = 0.0, longest = 0.0;  // s
};

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Tick next() = 0;
  // Cycles that passed without a tick since the last next(): the index of that tick is higher by so much. A
  // lockstep clock is never late: 0.
  [[nodiscard]] virtual std::int64_t missed() const noexcept { return 0; }
  // Since the start.
  [[nodiscard]] virtual Lateness lateness() const noexcept { return {}; }
};

}  // namespace enc
