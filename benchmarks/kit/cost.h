// What something costs, and that beside how wrong it is.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/statistics.h"

namespace enc::bench {

// Several ways to do the same, timed in turn, in an order drawn anew each round, so that a slow moment of the
// machine hits them all. Rounds before the first warm up. CPU time of this thread.
class Race {
 public:
  Race(std::size_t rounds, const std::vector<std::function<void()>>& ways, std::size_t warm_up = 1,
       std::uint64_t seed = 1);
  [[nodiscard]] double seconds(std::size_t way, double share = 0.5) const;  // below which that share lies
  // Median of what each round took, over what it took the other; also one of another race of as many rounds.
  [[nodiscard]] double ratio(std::size_t way, std::size_t over) const { return ratio(way, *this, over); }
  [[nodiscard]] double ratio(std::size_t way, const Race& race, std::size_t over) const;
  // How much longer all its rounds took than those of the other, without the tenth of the rounds in which the
  // two were farthest apart either way: s for each round.
  [[nodiscard]] double more(std::size_t way, std::size_t over) const;
  [[nodiscard]] double spent(std::size_t way, std::size_t round) const { return seconds_.at(way).at(round); }
  [[nodiscard]] const std::vector<double>& all(std::size_t way) const { return seconds_.at(way); }
  [[nodiscard]] std::size_t rounds() const { return seconds_.empty() ? 0 : seconds_.front().size(); }

 private:
  std::vector<std::vector<double>> seconds_;  // [way][round]
};

// Mean of the numbers without the twentieth at either end, and its standard error.
struct TrimmedMean {
  double mean = kUnset, doubt = kUnset;
};
[[nodiscard]] TrimmedMean trimmed_mean(std::vector<double> numbers);

// A way of a race that does a chunk of a long work at each call: work(i) of the next indices below `count`,
// then from 0 again. `count` is a multiple of `chunk`.
template <class Work>
[[nodiscard]] std::function<void()> in_chunks(std::size_t count, std::size_t chunk, Work work) {
  return [count, chunk, work, next = std::size_t{0}]() mutable {
    for (std::size_t i = 0; i < chunk; ++i) work(next + i);
    next = (next + chunk) % count;
  };
}

// The power of the step with which an error falls: least squares through the logarithms, over what stands
// clear of the floor by three times. Unset where that is fewer than three points.
[[nodiscard]] double fitted_order(const std::vector<double>& steps, const std::vector<double>& errors,
                                  double floor);

// One way with its settings from coarse to fine. An error that is NaN is a failure: a cross at the upper
// edge.
struct CostCurve {
  std::string name;
  std::vector<double> cost{}, error{};
};
// Both axes logarithmic. `plot` has all but the series.
[[nodiscard]] Plot cost_beside_error(Plot plot, const std::vector<CostCurve>& curves);

// A fixed piece of work, timed in the same run as what is judged: a bound on time is a ratio to it, so that a
// slow or busy machine turns no benchmark red.

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
