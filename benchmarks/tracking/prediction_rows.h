// Where the tool is now, when its newest pose is old: hold, constant velocity, constant acceleration, over
// the paper's motion and over motions it does not have [sources/tracking 4, sources/tracking 5,
// sources/choices 10].
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/tracking/motion.h"
#include "benchmarks/tracking/tracking_fit.h"
#include "sim/spec/twin_spec.h"

namespace enc::bench::tracking {

struct PredictionRow {
  std::string id, title;
  std::function<Motion(std::uint64_t seed)> motion;
  std::function<void(sim::TrackerTruth&)> change{};                 // of the tracker; none: as the rig has it
  bool with_bias = false;                                           // registration error kept
  bool moving_only = false;                                         // stops do not count
  bool peak = false;                                                // the largest error is what matters
  bool in_figures = false;                                          // of each prediction and kind of packets
  double from = 0.0, to = std::numeric_limits<double>::infinity();  // s of the motion that count
  double paper = kUnset;                                            // m
  double highest = kUnset;                                          // m: bound of constant velocity with
  std::size_t bound_on = 1;                                         // packets: 0 polled, 1 event
};

// acceleration: of the machine that makes the paper's moves, m/s^2; paper: what the rows of its moves are
// compared with.
[[nodiscard]] std::vector<PredictionRow> prediction_rows(double acceleration, const Table1& paper);

// Adds figures `tracking.predicted.*`, plots and tables to the benchmark `tracking`.
void add_prediction(const BenchContext& context, BenchResult& result);

}  // namespace enc::bench::tracking
