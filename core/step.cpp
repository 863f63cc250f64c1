#include "core/step.h"

#include <algorithm>

#include "core/rotation.h"
#include "core/task/meet/guide.h"
#include "core/task/walk.h"
#include "core/track/fuse.h"

namespace enc {
namespace {

// Of a belt against its prop: a running surface goes on at its own speed while the prop that stands for it
// moves along with the finger. On its way there it need not. Other props cannot run.
double driven(const Object& object, const Impedance& law, const Reaching& now, const Vec3& change) {
  if (object.interaction.kind != Interaction::spin || law.prop != PropKind::drum) return 0.0;
  const Vec<'W'> way = object.X_WO * Vec<'O'>(object.interaction.way);
  const Vec3 along = now.velocity.e() + law.rig.prop_lag * change;  // its motor is late
  return object.prop_speed() - (now.caught_up ? way.e().dot(along) : 0.0);
}

// No force is measured: what the finger feels is what the arm is told beyond gravity.
void report_arm(const stages::Walk& walk, const State& state, Outputs& out) {
  out.tip = Pose<'R', 'H'>();
  out.arm_force = walk.arm_force;
  out.wanted = state.reaching.target;
  out.gain = state.reaching.gain;
  const bool near = !stages::holding(walk) && state.object >= 0 &&
                    (state.mode == Mode::follow || state.mode == Mode::contact);
  out.prop_speed =
      near ? driven(walk.scene.objects[static_cast<std::size_t>(state.object)], *walk.scene.impedance,
                    state.reaching, state.mode == Mode::contact ? walk.target_change : Vec3::Zero())
           : 0.0;
  const bool touched = state.mode == Mode::contact && walk.gap < 0.0;
  out.deflection = touched ? -walk.gap : 0.0;
}

void report(const stages::Walk& walk, State& state, Outputs& out) {
  const bool engaged = state.mode == Mode::contact || state.mode == Mode::restore;
  const Pose<'N', 'W'> X_NW =
      walk.scene.probe ? walk.scene.probe->X_WN.inverse()
      : engaged        ? state.contact.X_WN.inverse()
                       : Pose<'W', 'N'>(rotation_z_to(walk.normal.e()), walk.surface_point).inverse();
  // Also in hold: to let go would drop the tool.
  if (walk.scene.clamped_tool >= 0) out.grip = {true, walk.scene.grip_force};
  out.tip = Pose<'R', 'H'>(walk.scene.X_WR.q().conjugate(), state.command);
  out.mode = stages::holding(walk) ? Mode::hold : state.mode;
  out.why = walk.why;
  out.object = state.object;
  out.contacts = state.contacts;
  out.gap = walk.gap;
  out.force = X_NW * state.force;
  out.felt = walk.felt;
  out.deflection = walk.scene.probe ? -(X_NW * walk.X_WH.origin()).xyz[2]
                                    : std::max(0.0, -state.contact.displacement.xyz[2]);
  out.first_touch =
      engaged ? state.contact.X_WN * Point<'N'>(0, 0, -walk.scene.tip_radius - stages::kSkin) : Point<'W'>();
  if (walk.scene.impedance) report_arm(walk, state, out);
  const SeenTool seen = seen_tool(walk, state);
  state.held = stages::holding(walk);
  out.view = {walk.tick.t, walk.tool_known ? state.tool.value.tool : -1, state.object, seen.X_WT, seen.tip,
              out.mode};
}

void walk_through(stages::Walk& walk, State& state, Outputs& out) noexcept {
  const Scene& scene = walk.scene;
  if (walk.in.missed >= scene.loop.late_cycles) walk.why |= kClockLate;
  stages::track(walk, state);  // where are the tool and the tip
  stages::touch(walk, state);  // which surface point is nearest, and how far
  stages::grip(walk);          // does the gripper hold its tool
  stages::sense(walk, state);  // what force is on the tip
  if (scene.impedance) {
    stages::push(walk, state);       // what does the finger move
    stages::encounter(walk, state);  // away, follow, contact; and where the prop should be
    stages::impede(walk, state);     // depth in, force out
    return report(walk, state, out);
  }
  stages::check_tip(walk, state);
  if (!stages::holding(walk)) {
    if (scene.probe) {
      stages::probe(walk, state);  // the object is real: pressed and measured, not rendered
    } else if (scene.travel) {
      stages::travel(walk, state);  // from stop to stop, whatever is around
    } else {
      stages::mode(walk, state);    // away, follow, contact, restore
      stages::model(walk, state);   // force in, displacement out
      stages::target(walk, state);  // where the tip should be
    }
  }
  stages::limit_command(walk, state);  // and what the machine is told
  report(walk, state, out);
}

}  // namespace

void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept {
  stages::Walk walk(scene, tick, in);
  walk_through(walk, state, out);
}

void guide(const Scene& scene, const Tick& tick, const Inputs& in, const Point<'W'>& to, State& state,
           Outputs& out) noexcept {
  stages::Walk walk(scene, tick, in);
  walk.sent = to;
  walk_through(walk, state, out);
}

}  // namespace enc
