// The stack of [VisHap] as a whole: parts of the benchmark `vishap`.
#pragma once

#include "benchmarks/kit/kit.h"

namespace enc::bench::vishap {

// The haptic device taken out of the left image, objects put in its place, and what an arm in view is to the
// tracker.
void add_device_removal(Bench& bench);
// A finger that the camera sees meets the prop: miss, force, time, and Fig 5.
void add_whole_stack(Bench& bench);

}  // namespace enc::bench::vishap
