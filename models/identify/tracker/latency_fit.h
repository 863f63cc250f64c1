// Bias, noise and latency of a tracker from a log, each with its 95 % interval: `encounter calibrate
// tracker`.
//
// A packet that comes at t shows the tip at t - age: tool(t) = tip(t - age) + bias + noise. Ages scatter;
// their mean is the latency. Weighted least squares for each axis: moving packets determine the latency,
// those at rest the bias. If an axis is moved both ways, the bias in motion is a free parameter, so that it
// cannot pass for latency. Intervals come from sums over blocks of time, because neighbouring errors are
// alike.
#pragma once

#include <array>

#include "models/identify/block_fit.h"
#include "models/identify/tracker/tracker_log.h"

namespace enc::models {

// Unset: the log does not determine it.
struct AxisLatency {
  Interval latency;           // s; unset: the axis was not moved
  Interval bias;              // m, at rest: tool minus tip
  Interval change;            // m: bias in motion minus bias at rest; known if it moved both ways
  Interval step;              // m: lag that does not grow with speed; known if speeds differ
  double noise = kUnset;      // m, rms about the bias at rest
  double places = kUnset;     // m: largest difference between the means of two stops
  double travel = 0.0;        // m
  double fastest = 0.0;       // m/s
  std::size_t stops = 0;      // stops of at least 0.3 s
  std::size_t moving = 0;     // moving packets
  std::size_t backwards = 0;  // moving packets in the rarer direction
  bool one_way = false;       // true: a bias that changes in motion counts as latency
  std::size_t at_rest = 0;    // packets at rest
  double wander = 0.0;        // m: motion of the tool, in medians over 0.25 s
  bool adrift = false;    // the tip stood still and the tool did not: the results do not describe the tracker
  double scale = kUnset;  // the tool's motion over the tip's; only for a moved axis
  double unexplained =
      kUnset;  // part of the tool's motion that the tip's does not explain; only for a moved axis
};

struct LatencyFit {
  std::array<AxisLatency, 3> axes;
  Interval latency;  // s: all axes together
  Interval scatter;  // s: standard deviation of the age, if only timing adds to a moving tool's noise
  // No axis differs from it by more than chance, at 5 %.
  bool axes_agree = true;
  // Part of the tool's motion that the tip's motion does not explain, for the moved axis with the largest
  // part: 0 the machine carries the tool, 1 the tool moves independently. Unset: no motion.
  double unexplained = kUnset;
  bool carried = true;       // false: the tip stood still, and the tool did not
  bool in_range = true;      // the latency is within the searched range
  std::size_t packets = 0;   // packets used
  std::size_t outliers = 0;  // left out: farther than 6 standard deviations
  Interval stamp_age;        // s: mean age by the stamps, and twice its scatter; unset: no stamps
  Interval stamp_error;      // s: age of the packets beyond that of their stamps
};

[[nodiscard]] LatencyFit fit_latency(const TrackerLog& log);

}  // namespace enc::models
