// Bias, noise and latency of a tracker out of a log, each with its 95 % interval: `encounter calibrate
// tracker`.
//
// A packet that comes at t shows where the tip was at t - age: tool(t) = tip(t - age) + bias + noise. Ages
// scatter; their mean is the latency. Weighted least squares per axis: moving packets know the latency, those
// at rest the bias. Where an axis is moved both ways, a bias that differs in motion is let free, so that it
// cannot pass for latency. Intervals come from sums over blocks of time, because neighbouring errors are
// alike.
#pragma once

#include <array>

#include "models/identify/block_error.h"
#include "models/identify/tracker/tracker_log.h"

namespace enc::models {

// Unset: the log cannot tell.
struct AxisLatency {
  Interval latency;             // s; unset: the axis was not moved
  Interval bias;                // m, at rest: tool minus tip
  Interval change;              // m: bias in motion less bias at rest; known where it moved both ways
  Interval step;                // m: lag that does not grow with speed; known where speeds differ
  double noise = kUnset;        // m, rms about the bias at rest
  double places = kUnset;       // m: largest difference between the means of two stops
  double travel = 0.0;          // m
  double fastest = 0.0;         // m/s
  std::size_t stops = 0;        // of at least 0.3 s
  std::size_t moving = 0;       // packets
  std::size_t backwards = 0;    // of these, those in the rarer direction
  bool one_way = false;         // then what of the bias changes in motion counts as latency
  std::size_t at_rest = 0;      // packets
  double wander = 0.0;          // m: what the tool moved by, in medians over 0.25 s
  bool adrift = false;          // the tip stood still and the tool did not: nothing here is of the tracker
  double scale = kUnset;        // the tool's motion over the tip's; where the axis was moved
  double unexplained = kUnset;  // part of the tool's motion that the tip's does not explain; likewise
};

struct LatencyFit {
  std::array<AxisLatency, 3> axes;
  Interval latency;        // s: of all axes together
  Interval scatter;        // s: standard deviation of the age, if timing is all that a moving tool adds
  bool axes_agree = true;  // no axis differs from it by more than chance, at 5 %
  // Part of the tool's motion that the tip's motion does not explain, of the moved axis that has most of it:
  // 0 the machine carries the tool, 1 it has nothing to do with it. Unset: nothing moved.
  double unexplained = kUnset;
  bool carried = true;       // false: the tip stood still, and the tool did not
  bool in_range = true;      // the latency is among those that were looked for
  std::size_t packets = 0;   // used
  std::size_t outliers = 0;  // left out: farther than 6 standard deviations
  Interval stamp_age;        // s: mean age that the stamps tell, and twice its scatter; unset: no stamps
  Interval stamp_error;      // s: how much older packets are than their stamps say
};

[[nodiscard]] LatencyFit fit_latency(const TrackerLog& log);

}  // namespace enc::models
