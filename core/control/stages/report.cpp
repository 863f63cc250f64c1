#include "core/control/stages/report.h"

#include <algorithm>
#include <cmath>

namespace enc {
namespace {

// Extrapolates the haptic-tip by its own velocity to the middle of the time for which this view is shown. It
// goes no deeper than the object's limit, where the machine stops it.
Point<'W'> haptic_tip_ahead(const stages::StepContext& context, const CommonState& state,
                            const Contact& contact) {
  const TipSample& sample = context.in.tip.value;
  const double ahead = context.scene.display.lead + age(context.tick.t, context.in.tip.t);
  const Point<'W'> tip = context.X_WH.origin() + ahead * (context.scene.X_WR * sample.velocity);
  const Object& object = context.scene.objects[static_cast<std::size_t>(contact.object)];
  const double now = -(contact.X_WN.inverse() * context.X_WH.origin()).xyz[2] - context.scene.tip_radius;
  const double then = -(contact.X_WN.inverse() * tip).xyz[2] - context.scene.tip_radius;
  const double over = then - std::max(now, object.limit_at(state.contacts));
  return over > 0.0 ? tip + over * (contact.X_WN * Vec<'N'>(0, 0, 1)) : tip;
}

// Extrapolates a tool that does not press, by the tracker's prediction; Prediction::hold extrapolates
// nothing.
Point<'W'> free_tip_ahead(const stages::StepContext& context, const CommonState& state) {
  const TrackerRig& rig = context.scene.tracker;
  if (rig.prediction == Prediction::hold) return context.tool_tip;
  const Time then = context.tick.t + from_seconds(context.scene.display.lead);
  return context.tool_tip +
         (predict(rig, state.tip_motion, then) - predict(rig, state.tip_motion, context.tick.t));
}

}  // namespace

Point<'W'> touching(const Point<'W'>& haptic_tip, double apart, const Point<'W'>& believed) {
  const Vec<'W'> way = believed - haptic_tip;
  const double far = way.norm();
  return far > 0.0 ? haptic_tip + (apart / far) * way : believed;
}

double pressing_share(double pressing_force, double contact_force) {
  return std::clamp(pressing_force / contact_force, 0.0, 1.0);
}

SeenTool seen_tool(const stages::StepContext& context, const CommonState& state,
                   const Contact* contact) noexcept {
  const DisplayRig& rig = context.scene.display;
  if (rig.tip == SeenTip::tracked) return {context.X_WT_newest, context.tip_newest};
  if (rig.tip == SeenTip::predicted || !context.tool_known) return {context.X_WT, context.tool_tip};
  const Point<'W'> free = free_tip_ahead(context, state);
  Vec<'W'> shift = free - context.tool_tip;
  if (contact != nullptr && state.mode == Mode::contact && context.force_unfiltered.finite() &&
      context.X_WH.valid()) {
    // Use the force before the low-pass: the filtered force would hold back a tool that has left.
    const double force = -dot(context.force_unfiltered, contact->X_WN * Vec<'N'>(0, 0, 1));
    const double apart =
        context.tool_radius + context.scene.tip_radius - rig.compliance * std::max(0.0, force);
    // The direction is the present one, the position the extrapolated one.
    const Vec<'W'> beside = touching(context.X_WH.origin(), apart, context.tool_tip) - context.X_WH.origin();
    const double share = pressing_share(force, context.scene.force.contact);
    shift = shift + share * (haptic_tip_ahead(context, state, *contact) + beside - free);
  }
  return {{context.X_WT.q(), context.X_WT.origin() + shift}, context.tool_tip + shift};
}

}  // namespace enc

namespace enc::stages {

void report_common(const StepContext& context, const CommonState& state, const Quat& q_WN,
                   const Contact* contact, Outputs& out) noexcept {
  out.mode = holding(context) ? Mode::hold : state.mode;
  out.why = context.why;
  out.object = state.object;
  out.contacts = state.contacts;
  out.gap = context.gap;
  out.force = Vec<'N'>(Vec3(q_WN.conjugate() * state.force.e()));
  out.force_unfiltered = context.force_unfiltered;
  const SeenTool seen = seen_tool(context, state, contact);
  out.view.t = context.tick.t;
  out.view.tool = context.tool_known ? state.tool.value.tool : -1;
  out.view.object = state.object;
  out.view.X_WT = seen.X_WT;
  out.view.tip = seen.tip;
  out.view.mode = out.mode;
}

void report_displaced(const StepContext& context, const CommandState& now, Outputs& out) noexcept {
  // Also in a hold: opening the jaws would drop the tool.
  if (context.scene.clamped_tool >= 0) out.manipulator.grip = {true, context.scene.grip_force};
  out.manipulator.tip = Pose<'R', 'H'>(context.scene.X_WR.q().conjugate(), now.command);
}

}  // namespace enc::stages
