#include "core/task/report.h"

#include "core/rotation.h"
#include "core/track/fuse.h"

namespace enc::stages {

Pose<'W', 'N'> surface_frame(const Walk& walk) noexcept {
  return {rotation_z_to(walk.normal.e()), walk.surface_point};
}

void report_common(const Walk& walk, const State& state, const Pose<'N', 'W'>& X_NW, const Contact* contact,
                   Outputs& out) noexcept {
  out.mode = holding(walk) ? Mode::hold : state.mode;
  out.why = walk.why;
  out.object = state.object;
  out.contacts = state.contacts;
  out.gap = walk.gap;
  out.force = X_NW * state.force;
  out.felt = walk.felt;
  const SeenTool seen = seen_tool(walk, state, contact);
  out.view = {walk.tick.t, walk.tool_known ? state.tool.value.tool : -1, state.object, seen.X_WT, seen.tip,
              out.mode};
}

void report_displaced(const Walk& walk, const Commanded& now, Outputs& out) noexcept {
  // Also in hold: to let go would drop the tool.
  if (walk.scene.clamped_tool >= 0) out.grip = {true, walk.scene.grip_force};
  out.tip = Pose<'R', 'H'>(walk.scene.X_WR.q().conjugate(), now.command);
}

}  // namespace enc::stages
