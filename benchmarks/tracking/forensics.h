// Checks that `encounter calibrate tracker` finds the injected values: logs of the simulated tracker with
// known latency and bias, and the method on the paper's own Table 1 [VHMR 4.1].
#pragma once

#include "benchmarks/kit/bench.h"
#include "models/identify/tracker/latency_fit.h"
#include "sim/spec/twin_spec.h"

namespace enc::bench::tracking {

// A tool that a machine moves along x, y and z, past the simulated tracker [VHMR 4.1].
struct LogSpec {
  sim::TrackerTruth tracker;
  std::vector<double> speeds{0.020, 0.040};  // m/s, one after another
  double dwell = 0.5;                        // s, at 0, 5, 10, 20, 40 mm
  bool both_ways = true;
  bool stamps = false;                         // uses the packets' own stamps
  std::array<bool, 3> axes{true, true, true};  // which are moved
};
struct MadeLog {
  models::TrackerLog log;
  double latency = kUnset;  // s: mean age of the packets that arrived while the tool moved
};
[[nodiscard]] MadeLog made_log(const LogSpec& spec, std::uint64_t seed);

// Figures tracking.forensics.*, a plot of found over injected, and a table of the results from Table 1 alone.
void add_forensics(const BenchContext& context, BenchResult& result);

}  // namespace enc::bench::tracking
