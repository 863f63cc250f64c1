// Parts of the benchmark `stiffness` [VHMR Fig 3].
#pragma once

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/benchmark.h"
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
// On all cores; push i of level j has the seed that belongs to the two alone.
[[nodiscard]] std::vector<Level> levels_of(const models::Setup& setup, const std::vector<double>& stiffnesses,
                                           std::size_t pushes, std::uint64_t seed,
                                           const Progress& progress = {});
// Slope of log |mean error| over log stiffness, least squares.
[[nodiscard]] double error_slope(const std::vector<Level>& levels, double Push::*felt, double from,
                                 double to);

// Nothing limits speed-up, in the core's commands nor in the machine.
[[nodiscard]] const std::vector<std::string>& unlimited_acceleration();
[[nodiscard]] const std::vector<std::string>& no_threshold_no_drift();
[[nodiscard]] const std::vector<std::string>& uncompensated_gripper();

// Fig 3 over the devices of the user's rig.
void over_rig(Bench& bench);

// Both explanations of the knee at 0.3 N/mm beside each other, as figures and a table.
void add_knee(const BenchContext& context, BenchResult& result);
// What `check` says of the softest spring, against the twin over a grid of hands and machines.
void add_softest(const BenchContext& context, BenchResult& result);
// Each effect switched off alone: what it does to the boundary and to the error.
void add_switches(const BenchContext& context, const Progress& progress, BenchResult& result);

}  // namespace enc::bench::stiffness
