// Parts of the benchmark `stiffness` [VHMR Fig 3].
#pragma once

#include "benchmarks/kit/bench.h"
#include "benchmarks/stiffness/push_study.h"

namespace enc::bench::stiffness {

// A share of the progress bar.
using Progress = std::function<void(double)>;

// Three pushes, or as many, at one commanded stiffness.
struct Level {
  double stiffness = kUnset;  // N/m
  std::vector<Push> pushes;

  [[nodiscard]] bool rendered() const;  // all pushes came to rest
};
// Over the pushes of a level, %.
struct Spread {
  double least = kUnset, mean = kUnset, most = kUnset;
  [[nodiscard]] double worst() const;  // the larger of the two, without its sign
};
[[nodiscard]] Spread spread(const Level& level, double Push::*felt);
// Slope of log |mean error| over log stiffness, least squares.
[[nodiscard]] double error_slope(const std::vector<Level>& levels, double Push::*felt, double from,
                                 double to);

// Nothing limits speed-up, in the core's commands nor in the machine.
[[nodiscard]] const std::vector<std::string>& unlimited_acceleration();

// Fig 3 over the devices of the user's rig.
void over_rig(Bench& bench);
// What `check` says of the softest spring, against the twin over a grid of hands and machines.
void add_softest(const BenchContext& context, BenchResult& result);

// Beyond the paper: how soft a wall the machine renders with the damper of
// core/control/task/admittance/damping.h, and what it costs.

// Adds figures `stiffness.beyond.*`, plots and tables to the benchmark `stiffness`.
void add_beyond(const BenchContext& context, const std::function<void(double)>& progress,
                BenchResult& result);

}  // namespace enc::bench::stiffness
