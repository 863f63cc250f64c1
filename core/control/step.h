// The whole haptic core is one pure function: no I/O, no clock, no heap, no lock [sources/choices 1].
//   track -> touch -> the task -> guard -> report
#pragma once

#include <type_traits>

#include "core/control/scene/scene.h"
#include "core/control/task/state.h"
#include "core/devices/signals.h"

namespace enc {

// A state that remembers another task begins that of the scene anew.
void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept;

static_assert(std::is_trivially_copyable_v<Inputs> && std::is_trivially_copyable_v<Outputs> &&
              std::is_trivially_copyable_v<State>);

}  // namespace enc
