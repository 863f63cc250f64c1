// The whole haptic core is one pure function: no I/O, no clock, no heap, no lock [sources/choices 1].
//   track -> touch -> the task -> guard -> report
#pragma once

#include <type_traits>

#include "core/signals.h"
#include "core/state.h"
#include "core/world/scene.h"

namespace enc {

// A state that remembers another task begins that of the scene anew.
void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept;

static_assert(std::is_trivially_copyable_v<Inputs> && std::is_trivially_copyable_v<Outputs> &&
              std::is_trivially_copyable_v<State>);

}  // namespace enc
