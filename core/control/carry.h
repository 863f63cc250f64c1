// A machine that a procedure sends from pose to pose with a clamped tool, such as a calibration.
#pragma once

#include "core/control/step.h"

namespace enc {

// A tick of a scene with [travel] as step() is, but the tip goes towards `to` instead of its next stop:
// within the machine's speed and acceleration, while the jaws hold the tool, and not in a hold. The tip turns
// as `to` is turned, at once: whoever asks turns it slowly, and sees to it that the machine reaches that
// pose. Not valid, in a hold, or without a tool: the tip waits where it is, turned as `out` of the tick
// before had it.
void carry(const Scene& scene, const Tick& tick, const Inputs& in, const Pose<'W', 'H'>& to, State& state,
           Outputs& out) noexcept;

}  // namespace enc
