// A machine that a procedure, such as a calibration, moves from pose to pose with a clamped tool.
#pragma once

#include "core/control/step.h"

namespace enc {

// Like step() of a scene with [travel], but the tip moves towards `to` instead of its next stop. The tip
// keeps within the machine's speed and acceleration and moves only while the jaws hold the tool and no hold
// is active. The tip takes the rotation of `to` at once: the caller must rotate `to` slowly and ensure that
// the machine reaches that pose. If `to` is invalid, in a hold, or without a tool, the tip waits with the
// rotation that `out` of the last tick had.
void carry(const Scene& scene, const Tick& tick, const Inputs& in, const Pose<'W', 'H'>& to, State& state,
           Outputs& out) noexcept;

}  // namespace enc
