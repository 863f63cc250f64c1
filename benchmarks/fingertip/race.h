// How long a stereo frame takes from pixels to the fingertip, beside OpenCV.
#pragma once

#include "benchmarks/kit/kit.h"
#include "benchmarks/staged/staged.h"

namespace enc::bench::fingertip {

// A finger that is followed at 300 mm/s. Without OpenCV there is no race.
void race(Bench& bench, const sim::CameraModule& camera, const SkinModel& skin);

}  // namespace enc::bench::fingertip
