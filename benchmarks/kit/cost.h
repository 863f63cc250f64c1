// The cost of work, and plots of cost against error.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/statistics.h"

namespace enc::bench {

// Several implementations of one task, timed in turn, in an order drawn anew each round, so that a slow
// moment of the machine hits them all. The first rounds warm up and do not count. CPU time of this thread.
class Race {
 public:
  Race(std::size_t rounds, const std::vector<std::function<void()>>& ways, std::size_t warm_up = 1,
       std::uint64_t seed = 1);
  [[nodiscard]] double seconds(std::size_t way, double share = 0.5) const;  // `share` of the rounds are below
  // Median over the rounds of `way`'s time over that of `over`; the second form takes `over` from another
  // race with as many rounds.
  [[nodiscard]] double ratio(std::size_t way, std::size_t over) const { return ratio(way, *this, over); }
  [[nodiscard]] double ratio(std::size_t way, const Race& race, std::size_t over) const;
  // Mean of the differences of round times, `way` less `over`, s per round. Leaves out the tenth of the
  // rounds in which the two were farthest apart, half of them at either end.
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

// Work of a race in chunks: each call runs work(i) on the next indices below `count`, then starts from 0
// again. `count` is a multiple of `chunk`.
template <class Work>
[[nodiscard]] std::function<void()> in_chunks(std::size_t count, std::size_t chunk, Work work) {
  return [count, chunk, work, next = std::size_t{0}]() mutable {
    for (std::size_t i = 0; i < chunk; ++i) work(next + i);
    next = (next + chunk) % count;
  };
}

// The power of the step with which an error falls: least squares through the logarithms of the errors above
// three times the floor. Unset for fewer than three points.
[[nodiscard]] double fitted_order(const std::vector<double>& steps, const std::vector<double>& errors,
                                  double floor);

// One implementation with its settings from coarse to fine. An error that is NaN is a failure: a cross at the
// upper edge.
struct CostCurve {
  std::string name;
  std::vector<double> cost{}, error{};
};
// An error that a diagram marks by a line, such as the one asked for.
struct ErrorLevel {
  std::string name;
  double error = kUnset;
};
// Both axes are logarithmic. `plot` has everything but the series. A level that is not above 0 has no line.
[[nodiscard]] Plot cost_beside_error(Plot plot, const std::vector<CostCurve>& curves,
                                     const std::vector<ErrorLevel>& levels = {});

// A fixed piece of work, timed in the run that is judged. A bound on time is a ratio to this work, so that a
// slow or busy computer fails no benchmark.

class Yardstick {
 public:
  // Times the work once. Call it many times between the calls that are judged. CPU time of this thread.
  void measure() {
    const double start = thread_seconds();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      sum_ = sum_ * 0.75 + cells_[i];  // each step waits for the one before, and for its cell
      cells_[(i * 7) % cells_.size()] = 1.0 / (1.0 + sum_ * sum_);
    }
    seconds_.push_back(thread_seconds() - start);
  }
  // Observes a trial (TrialOptions::watch), and measures now and then.
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

// s, over 64 in a row: the reference for a run between two such measurements.
[[nodiscard]] inline double yardstick_now() {
  Yardstick yardstick;
  for (int i = 0; i < 64; ++i) yardstick.measure();
  return yardstick.seconds();
}

}  // namespace enc::bench
