// Order statistics and a clock of this thread, shared by benchmarks and reports.
#pragma once

#include <cmath>
#include <ctime>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "models/order_statistics.h"

namespace enc::bench {

using models::median;
using models::percentile;

// The percentile of a figure, and the last token of its id: the percentile itself ("p95"). With too few
// values for it: the largest ("max"; for a share below a half the smallest, "min").
struct Tail {
  double value;
  std::string word;
};
[[nodiscard]] inline Tail tail_of(const std::vector<double>& values, double share) {
  if (models::has_percentile(values.size(), share))
    return {percentile(values, share), fmt::format("p{:02.0f}", 100.0 * share)};
  return share < 0.5 ? Tail{percentile(values, 0.0), "min"} : Tail{percentile(values, 1.0), "max"};
}

// Root of the mean square, and the mean; NaN for no values.
[[nodiscard]] inline double rms(const std::vector<double>& values) {
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}
[[nodiscard]] inline double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// s of CPU time of this thread: other programs on the machine do not count.
[[nodiscard]] inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace enc::bench
