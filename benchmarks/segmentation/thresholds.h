// ROC over the two thresholds, on training seeds: where SegmentationSpec's defaults come from.
#pragma once

#include "benchmarks/kit/kit.h"
#include "benchmarks/segmentation/pairs.h"

namespace enc::bench::segmentation {

// Of the three sceneries in turn, in four lights; `like` has camera and skin.
void judge_thresholds(Bench& bench, const Place& like);

}  // namespace enc::bench::segmentation
