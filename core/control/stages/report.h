// The part of a tick's outputs that every task reports. Internal to the core.
#pragma once

#include "core/control/stages/displacement.h"
#include "core/control/stages/step_context.h"

namespace enc::stages {

// Mode, reasons, force and display. `q_WN`: axes of N in which the force is reported; `contact`: null without
// a contact.
void report_common(const StepContext& context, const CommonState& state, const Quat& q_WN,
                   const Contact* contact, Outputs& out) noexcept;
// The set-point of a machine that takes positions, and the gripper command.
void report_displaced(const StepContext& context, const CommandState& now, Outputs& out) noexcept;

}  // namespace enc::stages

namespace enc {

// Centre of a tool's tip that touches the haptic-tip: `apart` (m, the two radii together) from it, in the
// direction of `believed`. Returns `believed` itself if it coincides with the haptic-tip's centre.
[[nodiscard]] Point<'W'> touching(const Point<'W'>& haptic_tip, double apart, const Point<'W'>& believed);

// Share of the tool's position taken from the haptic-tip: 0 without force, 1 from the contact force on, so
// that the shown tool does not jump between the two sources.
[[nodiscard]] double pressing_share(double pressing_force, double contact_force);

// The tool in the view. Its rotation is the tracker's, because the machine does not measure it.
struct SeenTool {
  Pose<'W', 'T'> X_WT;
  Point<'W'> tip;  // centre of its tip
};
// Chooses the tool pose that the display shows (DisplayRig::tip). While a tool presses, its tip touches the
// haptic-tip. The machine measures that position to a few micrometres in each cycle, far better than the
// tracker measures the tool.
[[nodiscard]] SeenTool seen_tool(const stages::StepContext& context, const CommonState& state,
                                 const Contact* contact) noexcept;

}  // namespace enc
