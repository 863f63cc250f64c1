// step() driven by hand: ways into each mode on a ball, and what holds on every tick.
#pragma once

#include "core/control/stages/walk.h"
#include "tests/support/scenes.h"

namespace enc::test {

using stages::kSkin;
inline constexpr double kTipRadius = 0.005;  // m, RigSpec

[[nodiscard]] Loop make(const SceneSpec& spec, const RigSpec& rig = exact_rig());
[[nodiscard]] SceneSpec with_display();

// Tool above the top with its surface `gap` over it, tared, and the tip waiting under it.
void wait_under(Loop& loop, double gap = 0.010);
// The tool presses with 4.05 N.
void to_contact(Loop& loop);
// A drawn surface, 20 ms old.
void draw(Inputs& in, const Loop& loop);

void expect_within_limits(const Loop& loop);

}  // namespace enc::test
