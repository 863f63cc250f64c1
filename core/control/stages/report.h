// What every task says of a tick. Internal to the core.
#pragma once

#include "core/control/stages/displacing.h"
#include "core/control/stages/walk.h"

namespace enc::stages {

// Mode, reasons, force and what is shown. `q_WN`: axes of N in which the force is told; `contact`: null where
// nothing is felt.
void report_common(const Walk& walk, const CommonState& state, const Quat& q_WN, const Contact* contact,
                   Outputs& out) noexcept;
// The set-point of a machine that takes positions; and the gripper.
void report_displaced(const Walk& walk, const Commanded& now, Outputs& out) noexcept;

}  // namespace enc::stages
