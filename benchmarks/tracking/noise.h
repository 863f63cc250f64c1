// The tracker's jitter: a tool at rest, seen for a minute. Its size and spectrum along each axis.
#pragma once

#include "benchmarks/kit/kit.h"

namespace enc::bench::tracking {

// Figures tracking.noise.* and a plot.
void add_noise(Bench& bench);

}  // namespace enc::bench::tracking
