// The whole haptic core is one pure function: no I/O, no clock, no heap, no lock [sources/choices 1].
//   track -> touch -> the task -> guard -> report
#pragma once

#include <type_traits>

#include "core/control/scene/scene.h"
#include "core/control/task/tasks.h"
#include "core/devices/signals.h"

namespace enc {

// If `state` belongs to another task, step() starts the state of the scene's task anew.
void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept;

// A procedure, such as a calibration, moves an arm by guide() from place to place without a user. Like
// step(), but while no finger is followed, the tip moves to `to` instead of waiting. The target keeps within
// the usual speed and acceleration; control law and gravity compensation are unchanged. If `to` is not
// finite, the tip waits.
void guide(const Scene& scene, const Tick& tick, const Inputs& in, const Point<'W'>& to, State& state,
           Outputs& out) noexcept;

// A procedure, such as a calibration, moves a machine by carry() from pose to pose with a clamped tool. Like
// step() of a scene with [travel], but the tip moves towards `to` instead of its next stop. The tip keeps
// within the machine's speed and acceleration and moves only while the jaws hold the tool and no hold is
// active. The tip takes the rotation of `to` at once: the caller must rotate `to` slowly and ensure that the
// machine reaches that pose. If `to` is invalid, in a hold, or without a tool, the tip waits with the
// rotation that `out` of the last tick had.
void carry(const Scene& scene, const Tick& tick, const Inputs& in, const Pose<'W', 'H'>& to, State& state,
           Outputs& out) noexcept;

static_assert(std::is_trivially_copyable_v<Inputs> && std::is_trivially_copyable_v<Outputs> &&
              std::is_trivially_copyable_v<State>);

}  // namespace enc
