#include "core/control/stages/report.h"

#include "core/control/stages/fuse.h"

namespace enc::stages {

void report_common(const Walk& walk, const CommonState& state, const Quat& q_WN, const Contact* contact,
                   Outputs& out) noexcept {
  out.mode = holding(walk) ? Mode::hold : state.mode;
  out.why = walk.why;
  out.object = state.object;
  out.contacts = state.contacts;
  out.gap = walk.gap;
  out.force = Vec<'N'>(Vec3(q_WN.conjugate() * state.force.e()));
  out.felt = walk.felt;
  const SeenTool seen = seen_tool(walk, state, contact);
  out.view.t = walk.tick.t;
  out.view.tool = walk.tool_known ? state.tool.value.tool : -1;
  out.view.object = state.object;
  out.view.X_WT = seen.X_WT;
  out.view.tip = seen.tip;
  out.view.mode = out.mode;
}

void report_displaced(const Walk& walk, const Commanded& now, Outputs& out) noexcept {
  // Also in hold: to let go would drop the tool.
  if (walk.scene.clamped_tool >= 0) out.grip = {true, walk.scene.grip_force};
  out.tip = Pose<'R', 'H'>(walk.scene.X_WR.q().conjugate(), now.command);
}

}  // namespace enc::stages
