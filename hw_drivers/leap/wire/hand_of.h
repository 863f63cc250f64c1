// A hand of LeapC and a hand of the core, and back. L has the axes of the device's own coordinates, which are
// right-handed with y away from the device; K those of the palm, with its origin at the wrist.
#pragma once

#include "core/base/hand_sample.h"
#include "hw_drivers/leap/wire/leapc.h"

namespace enc::leap {

// Returns false if it cannot be a hand: numbers that are not finite or too far away, no rotation.
[[nodiscard]] bool hand_of(const leapc::Hand& said, HandSample& hand) noexcept;
[[nodiscard]] leapc::Hand said_of(const HandSample& hand) noexcept;

}  // namespace enc::leap
