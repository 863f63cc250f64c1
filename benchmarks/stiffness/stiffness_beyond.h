// Beyond the paper: how soft a wall the machine renders with the damper of
// core/control/task/render/damping.h, and what it costs.
#pragma once

#include "benchmarks/kit/bench.h"

namespace enc::bench::stiffness {

// Adds figures `stiffness.beyond.*`, plots and tables to the benchmark `stiffness`.
void add_beyond(const BenchContext& context, const std::function<void(double)>& progress,
                BenchResult& result);

}  // namespace enc::bench::stiffness
