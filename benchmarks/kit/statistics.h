// Order statistics and a clock of this thread: what benchmarks and reports share.
#pragma once

#include <cmath>
#include <ctime>
#include <numeric>
#include <vector>

#include "models/order_statistics.h"

namespace enc::bench {

using models::median;
using models::percentile;

// Root of the mean square, and the mean; NaN of none.
[[nodiscard]] inline double rms(const std::vector<double>& values) {
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}
[[nodiscard]] inline double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// s of CPU time of this thread: what other programs do on the machine does not count.
[[nodiscard]] inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace enc::bench
