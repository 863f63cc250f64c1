// The factors that the printed pseudo-code has lost, steps 5 and 7, and the size of the square of step 6:
// what each value of them finds.
#pragma once

#include "benchmarks/staged/staged.h"

namespace enc::bench::fingertip::factors {

// On training seeds, so that whoever chooses a value by them has not looked at those that are judged.
void tell(Bench& bench, const sim::CameraModule& camera, const SkinModel& skin);

}  // namespace enc::bench::fingertip::factors
