// What every task says of a tick. Internal to the core.
#pragma once

#include "core/task/walk.h"

namespace enc::stages {

// Of the surface under the tool.
[[nodiscard]] Pose<'W', 'N'> surface_frame(const Walk& walk) noexcept;
// Mode, reasons, force in N, and what is shown. `contact`: null where nothing is felt.
void report_common(const Walk& walk, const State& state, const Pose<'N', 'W'>& X_NW, const Contact* contact,
                   Outputs& out) noexcept;
// The set-point of a machine that takes positions; and the gripper.
void report_displaced(const Walk& walk, const Commanded& now, Outputs& out) noexcept;

}  // namespace enc::stages
