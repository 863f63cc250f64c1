// An arm that a procedure, such as a calibration, moves from place to place without a user.
#pragma once

#include "core/control/step.h"

namespace enc {

// Like step(), but while no finger is followed, the tip moves to `to` instead of waiting. The target keeps
// within the usual speed and acceleration; control law and gravity compensation are unchanged. If `to` is not
// finite, the tip waits.
void guide(const Scene& scene, const Tick& tick, const Inputs& in, const Point<'W'>& to, State& state,
           Outputs& out) noexcept;

}  // namespace enc
