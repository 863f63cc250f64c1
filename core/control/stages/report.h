// The part of a tick's outputs that every task reports. Internal to the core.
#pragma once

#include "core/control/stages/displacing.h"
#include "core/control/stages/walk.h"

namespace enc::stages {

// Mode, reasons, force and display. `q_WN`: axes of N in which the force is reported; `contact`: null without
// a contact.
void report_common(const Walk& walk, const CommonState& state, const Quat& q_WN, const Contact* contact,
                   Outputs& out) noexcept;
// The set-point of a machine that takes positions, and the gripper command.
void report_displaced(const Walk& walk, const Commanded& now, Outputs& out) noexcept;

}  // namespace enc::stages
