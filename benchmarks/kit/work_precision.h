// Error against run time: one run repeated over the form of the hexapod, the integrator and the time step,
// each judged by a converged run of the same form. Failures are points, too.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

struct WorkSpec {
  std::string benchmark;         // first token of the ids
  std::string scene;             // in models/scenes, without ".toml"
  std::vector<std::string> set;  // the run itself, without step, integrator and form
  double seconds = kUnset;       // s, of experiment; unset: until the scene's programme is over
  double accuracy = kUnset;      // m rms of the true tip's path: what this benchmark needs
};

// The default step and integrator of each form must meet the accuracy, and of the control form no point that
// meets it may be much cheaper. With elastic legs (the structural form) it is judged with --full alone, and
// may err by as much more as two converged runs differ by. Throws Error where the converged run fails. Runs
// alone on one core: it measures time. By default a small form of some seconds, which judges the default
// alone; with --full all of it.
void add_work_precision(const WorkSpec& spec, const BenchContext& context, BenchResult& result);

}  // namespace enc::bench
