// The benchmark `session`: what many sessions have shown, for its plots.
#pragma once

#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/session/session_measure.h"

namespace enc::bench::session {

// A tick of the session that is drawn.
struct SessionSample {
  double t;           // s
  double speed;       // of the tool's tip, m/s, true
  double deflection;  // m, true, of the haptic-tip below the undeformed surface
  Mode mode;
  sim::Phase phase;
  std::int32_t press, tool, shown;  // shown: the overlay's tool
};

struct SessionRun {
  std::vector<SessionPress> presses;
  ToolChange change;
  double tension = 0.0, simulated = 0.0;  // N, s
  std::int64_t beyond = 0, holds = 0, ticks = 0;
  std::uint32_t hold_reasons = 0;
};

void add_session_plots(const std::vector<SessionRun>& runs, const std::vector<SessionSample>& drawn,
                       BenchResult& result);

}  // namespace enc::bench::session
