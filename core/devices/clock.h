// Who owns time owns the loop. A simulated clock advances its world by one period; a machine's waits for the
// cycle.
#pragma once

#include "core/time.h"

namespace enc {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Tick next() = 0;
  // Cycles that passed without a tick since the last next(). A lockstep clock is never late: 0.
  [[nodiscard]] virtual std::int64_t missed() const noexcept { return 0; }
};

}  // namespace enc
