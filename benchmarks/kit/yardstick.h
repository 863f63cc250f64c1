// A fixed piece of work, timed in the same run as what is judged: a bound on time is a ratio to it, so that a
// slow or busy machine turns no benchmark red.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "benchmarks/kit/statistics.h"

namespace enc::bench {

class Yardstick {
 public:
  // Times it once. To be called between the calls of what is judged, many times. CPU time of this thread.
  void measure() {
    const double start = thread_seconds();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      sum_ = sum_ * 0.75 + cells_[i];  // each waits for the one before, and for its cell
      cells_[(i * 7) % cells_.size()] = 1.0 / (1.0 + sum_ * sum_);
    }
    seconds_.push_back(thread_seconds() - start);
  }
  // Looks on at a trial (TrialOptions::watch), and measures now and then.
  [[nodiscard]] auto watch() {
    return [this](const auto& glance) {
      if (glance.tick.index % 100 == 0) measure();
    };
  }
  [[nodiscard]] double seconds() const { return median(seconds_); }  // of one

 private:
  std::array<double, 512> cells_{};
  double sum_ = 1.0;
  std::vector<double> seconds_;
};

// Of 64 in a row, s: what a run between two of them is compared with.
[[nodiscard]] inline double yardstick_now() {
  Yardstick yardstick;
  for (int i = 0; i < 64; ++i) yardstick.measure();
  return yardstick.seconds();
}

}  // namespace enc::bench
