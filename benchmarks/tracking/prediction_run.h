// The simulated tracker and the core's prediction along a scripted motion, without a machine: how far is the
// tip from where the core takes it to be?
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "benchmarks/tracking/motion.h"
#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"

namespace enc::bench::tracking {

inline constexpr std::array<Prediction, 3> kPredictions{Prediction::hold, Prediction::constant_velocity,
                                                        Prediction::constant_acceleration};

// A motion, what the tracker is like on it, and which part of it counts.
struct PredictionRun {
  Motion motion;
  sim::TrackerTruth truth;  // its black-out counts from the motion's start
  std::uint64_t seed = 1;
  bool moving_only = false;                                         // without the stops
  double from = 0.0, to = std::numeric_limits<double>::infinity();  // s since the motion's start
};

struct TipErrors {
  double at_packets = kUnset;  // m, rms of the distance, on ticks with a new pose
  double at_ticks = kUnset;    // m, the same on every tick
  double peak = 0.0;           // m, largest along an axis, on every tick
  double largest_step = 0.0;   // m: of the prediction beyond the tool's own in a tick
};
// On one tick, along x: what a plot over time shows.
struct TipTrace {
  std::vector<double> time;                  // s since the motion's start
  std::array<std::vector<double>, 3> error;  // m, for each prediction
};

// Runs the motion with each prediction on the same packets. The scene has the core's settings; `trace` may be
// null.
[[nodiscard]] std::array<TipErrors, 3> predicted_run(const Scene& scene, const Pose<'W', 'C'>& true_X_WC,
                                                     const PredictionRun& run, TipTrace* trace = nullptr);

}  // namespace enc::bench::tracking
