#include "core/control/task/impedance/impedance_task.h"

#include <cmath>

#include "core/base/rotation.h"
#include "core/control/stages/report.h"
#include "core/control/task/impedance/finger.h"
#include "core/control/task/impedance/impedance_spec.h"

namespace enc::stages {
namespace {

// An arm's tip turns with its joints, but only its position is rendered, so H keeps the axes of R.
void track_arm(ArmContext& context, const Impedance& task, CommonState& state) {
  const Measurement<ArmSample>& sample = context.in.arm;
  if (sample.health == Health::absent || age(context.tick.t, sample.t) > task.rig.stale) {
    context.why |= kTipLost;
    return;
  }
  const ArmSample& arm = sample.value;
  bool usable = sample.health == Health::ok && arm.tip.finite() && arm.tip.e().norm() < MeetSpec::kFarthest &&
                arm.velocity.finite() && arm.velocity.norm() < MeetSpec::kFastest &&
                sample.t <= context.tick.t + context.tick.dt;
  for (const double q : arm.joints) usable = usable && std::abs(q) < MeetSpec::kMostTurned;  // false for NaN
  if (!usable) {
    context.why |= kTipInvalid;
    return;
  }
  context.X_WH = context.scene.X_WR * Pose<'R', 'H'>(Quat::Identity(), arm.tip);
  context.tip_velocity = context.scene.X_WR * arm.velocity;
  context.jacobian = task.arm.jacobian(arm.joints);
  state.started = true;
}

// Speed of a belt relative to its prop. A running surface keeps its own speed while its prop moves along with
// the finger. A prop on its way there need not run. Other props cannot run.
double driven(const Object& object, const Impedance& law, const Aim& now, const Vec3& change) {
  if (object.interaction.kind != Interaction::spin || law.prop != PropKind::drum) return 0.0;
  const Vec<'W'> way = object.X_WO * Vec<'O'>(object.interaction.way);
  const Vec3 along = now.velocity.e() + law.rig.prop_lag * change;  // its motor lags
  return object.prop_speed() - (now.caught_up ? way.e().dot(along) : 0.0);
}

}  // namespace

void track(ArmContext& context, const Impedance& task, CommonState& state, ImpedanceState& now) noexcept {
  track_arm(context, task, state);
  track_tool(context, state, {.pressing = presses(state, now.contact)});
}

// An arm renders touch: any touched object precedes all untouched ones.
void touch(ArmContext& context, const Impedance&, CommonState& state, ImpedanceState& now) noexcept {
  const bool touched = state.mode == Mode::contact, ahead = !touched && context.scene.follow.ahead > 0.0;
  nearest_surface(
      context, state,
      {touched ? &now.contact : nullptr, true, ahead ? comes_to(context, now) : Point<'W'>(), context.moved});
}

void act(ArmContext& context, const Impedance& task, CommonState& state, ImpedanceState& now) noexcept {
  aim(context, task, state, now);
  render_impedance(context, task, state, now);
}

// The arm measures no force: the finger feels the commanded force beyond gravity compensation.
void report(const ArmContext& context, const Impedance& task, CommonState& state, const ImpedanceState& now,
            Outputs& out) noexcept {
  const bool touched = state.mode == Mode::contact;
  report_common(context, state, touched ? Quat(now.contact.X_WN.q()) : rotation_z_to(context.normal.e()),
                &now.contact, out);
  out.manipulator.tip = Pose<'R', 'H'>();
  out.arm.force = context.commanded_force;
  out.arm.target = now.aim.target;
  out.arm.gain = now.aim.gain;
  const Object* object = nearest_object(context, state);
  const bool near = !holding(context) && object != nullptr && (state.mode == Mode::follow || touched);
  out.arm.prop_speed =
      near ? driven(*object, task, now.aim, touched ? context.target_change : Vec3::Zero()) : 0.0;
  const Vec<'W'> facing = touched ? now.contact.X_WN * Vec<'N'>(0, 0, 1) : context.normal;
  out.arm.prop_facing = near && facing.finite() ? context.scene.X_WR.inverse() * facing : Vec<'R'>();
  out.deflection = touched && context.gap < 0.0 ? -context.gap : 0.0;
  out.first_touch =
      touched ? now.contact.X_WN * Point<'N'>(0, 0, -context.scene.tip_radius - kSkin) : Point<'W'>();
}

}  // namespace enc::stages
