// Order statistics and a clock of this thread: what benchmarks and reports share.
#pragma once

#include <ctime>

#include "models/order_statistics.h"

namespace enc::bench {

using models::median;
using models::percentile;

// s of CPU time of this thread: what other programs do on the machine does not count.
[[nodiscard]] inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace enc::bench
