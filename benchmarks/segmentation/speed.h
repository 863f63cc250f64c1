// How long a frame takes, beside OpenCV and beside a copy of the frame.
#pragma once

#include "benchmarks/kit/kit.h"
#include "benchmarks/segmentation/pairs.h"

namespace enc::bench::segmentation {

// A hand that moves in the light of the background, in `place`.
void race(Bench& bench, const Place& place);

}  // namespace enc::bench::segmentation
