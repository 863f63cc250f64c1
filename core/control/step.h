// The whole haptic core is one pure function: no I/O, no clock, no heap, no lock [sources/choices 1].
//   track -> touch -> the task -> guard -> report
#pragma once

#include <type_traits>

#include "core/control/scene/scene.h"
#include "core/control/task/state.h"
#include "core/devices/signals.h"

namespace enc {

// If `state` belongs to another task, step() starts the state of the scene's task anew.
void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept;

static_assert(std::is_trivially_copyable_v<Inputs> && std::is_trivially_copyable_v<Outputs> &&
              std::is_trivially_copyable_v<State>);

}  // namespace enc
