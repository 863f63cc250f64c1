// Where the tool is now, when its newest pose is old: hold, constant velocity, constant acceleration, over
// the paper's motion and over motions it does not have [sources/choices 10].
#pragma once

#include "benchmarks/kit/bench.h"

namespace enc::bench::tracking {

// Adds figures `tracking.predicted.*`, plots and tables to the benchmark `tracking`.
void add_prediction(const BenchContext& context, BenchResult& result);

}  // namespace enc::bench::tracking
