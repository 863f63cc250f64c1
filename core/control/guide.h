// An arm that a procedure sends from place to place, such as a calibration: nobody is met there.
#pragma once

#include "core/control/step.h"

namespace enc {

// A tick as step() is, but while no finger is followed the tip goes to `to` instead of waiting where it is:
// the same target that keeps within speed and acceleration, the same law, the same gravity compensation. Not
// finite: it waits.
void guide(const Scene& scene, const Tick& tick, const Inputs& in, const Point<'W'>& to, State& state,
           Outputs& out) noexcept;

}  // namespace enc
