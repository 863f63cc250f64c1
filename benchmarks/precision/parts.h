// The parts of the benchmark beside its page of errors.
#pragma once

#include <vector>

#include "benchmarks/kit/force_precision.h"

namespace enc::bench::precision {

// With which power of the step the error falls, where nothing touches, sticks or is counted: theory has one
// for each integrator.
void add_orders(Bench& bench);

// Advice as `check --advise` gives it, carried out: judged by a converged run of another step.
void add_advice(Bench& bench, const std::vector<ForceStudy>& studies);

}  // namespace enc::bench::precision
