// What something costs, and that beside how wrong it is.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

// Several ways to do the same, timed in turn, so that a slow moment of the machine hits them all. Who goes
// first alternates; a round before the first warms up. CPU time of this thread.
class Race {
 public:
  Race(int rounds, const std::vector<std::function<void()>>& ways);
  [[nodiscard]] double seconds(std::size_t way) const;                  // median
  [[nodiscard]] double ratio(std::size_t way, std::size_t over) const;  // median of that of each round

 private:
  std::vector<std::vector<double>> seconds_;  // [way][round]
};

// One way with its settings from coarse to fine. An error that is NaN is a failure: a cross at the upper
// edge.
struct CostCurve {
  std::string name;
  std::vector<double> cost{}, error{};
};
// Both axes logarithmic. `plot` has all but the series.
[[nodiscard]] Plot cost_beside_error(Plot plot, const std::vector<CostCurve>& curves);

}  // namespace enc::bench
