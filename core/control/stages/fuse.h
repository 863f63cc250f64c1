// Which tool the eye is shown (DisplayRig::tip). While a tool presses, its tip touches the haptic-tip, whose
// place the machine knows each cycle to a few micrometres: far better than the tracker knows the tool.
#pragma once

#include "core/control/stages/walk.h"

namespace enc {

// The centre of a tool's tip that touches the haptic-tip: in the direction in which it is `believed`, as far
// off as the two radii together (`apart`, m). `believed` itself where it is in the haptic-tip's very middle.
[[nodiscard]] Point<'W'> touching(const Point<'W'>& haptic_tip, double apart, const Point<'W'>& believed);

// How much of the tool's place is taken from the haptic-tip: 0 where nothing presses, 1 from the force on
// that is a contact, so that the seen tool does not leap from one source to the other.
[[nodiscard]] double pressing_share(double pressing_force, double contact_force);

// The tool of the view. Its rotation is the tracker's: the machine does not feel it.
struct SeenTool {
  Pose<'W', 'T'> X_WT;
  Point<'W'> tip;  // centre of its tip
};
[[nodiscard]] SeenTool seen_tool(const stages::Walk& walk, const CommonState& state,
                                 const Contact* contact) noexcept;

}  // namespace enc
