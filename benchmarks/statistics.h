// Order statistics and a clock of this thread: what benchmarks and reports share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <vector>

#include "core/frames.h"

namespace enc::bench {

// The value below which `share` (0 to 1) of them lie, by nearest rank; NaN where there is none.
template <class T>
[[nodiscard]] double percentile(std::vector<T> values, double share) {
  if (values.empty()) return kUnset;
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return static_cast<double>(values[rank]);
}
template <class T>
[[nodiscard]] double median(const std::vector<T>& values) {
  return percentile(values, 0.5);
}

// s of CPU time of this thread: what other programs do on the machine does not count.
[[nodiscard]] inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace enc::bench
