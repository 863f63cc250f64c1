// Parts of the benchmark `stiffness` [VHMR Fig 3].
#pragma once

#include "benchmarks/kit/entry.h"
#include "benchmarks/stiffness/push_study.h"

namespace enc::bench::stiffness {

// A share of the progress bar.
using Progress = std::function<void(double)>;

// The pushes at one commanded stiffness.
struct Level {
  double stiffness = kUnset;  // N/m
  std::vector<Push> pushes;

  [[nodiscard]] bool rendered() const;  // all pushes came to rest
};
// Statistics over the pushes of a level, %.
struct Spread {
  double least = kUnset, mean = kUnset, most = kUnset;
  std::vector<double> values{};
  [[nodiscard]] double worst() const;  // the larger of the two, without sign
};
[[nodiscard]] Spread spread(const Level& level, double Push::*felt);
// Slope of log |mean error| over log stiffness, least squares.
[[nodiscard]] double error_slope(const std::vector<Level>& levels, double Push::*felt, double from,
                                 double to);

// No limit on acceleration, in the core's commands and in the machine.
[[nodiscard]] const std::vector<std::string>& unlimited_acceleration();

// Fig 3 over the devices of the user's rig.
void over_rig(Bench& bench);
// The softest spring of `check`, against the twin over a grid of hands and machines.
void add_softest(const BenchContext& context, BenchResult& result);

// Beyond the paper: the softest wall of the machine with the damper of
// core/control/task/admittance/damping.h, and its cost.

// Adds figures `stiffness.beyond.*`, plots and tables to the benchmark `stiffness`.
void add_beyond(const BenchContext& context, const std::function<void(double)>& progress,
                BenchResult& result);

}  // namespace enc::bench::stiffness
