#include "core/control/stages/report.h"

#include <algorithm>
#include <cmath>

namespace enc {
namespace {

// Extrapolates the haptic-tip by its own velocity to the middle of the time for which this view is shown. It
// goes no deeper than the object's limit, where the machine stops it.
Point<'W'> haptic_tip_ahead(const stages::Walk& walk, const CommonState& state, const Contact& contact) {
  const TipSample& sample = walk.in.tip.value;
  const double ahead = walk.scene.display.lead + age(walk.tick.t, walk.in.tip.t);
  const Point<'W'> tip = walk.X_WH.origin() + ahead * (walk.scene.X_WR * sample.velocity);
  const Object& object = walk.scene.objects[static_cast<std::size_t>(contact.object)];
  const double now = -(contact.X_WN.inverse() * walk.X_WH.origin()).xyz[2] - walk.scene.tip_radius;
  const double then = -(contact.X_WN.inverse() * tip).xyz[2] - walk.scene.tip_radius;
  const double over = then - std::max(now, object.limit_at(state.contacts));
  return over > 0.0 ? tip + over * (contact.X_WN * Vec<'N'>(0, 0, 1)) : tip;
}

// Extrapolates a tool that does not press, by the tracker's prediction; Prediction::hold extrapolates
// nothing.
Point<'W'> free_tip_ahead(const stages::Walk& walk, const CommonState& state) {
  const TrackerRig& rig = walk.scene.tracker;
  if (rig.prediction == Prediction::hold) return walk.tool_tip;
  const Time then = walk.tick.t + from_seconds(walk.scene.display.lead);
  return walk.tool_tip + (predict(rig, state.tip_motion, then) - predict(rig, state.tip_motion, walk.tick.t));
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

SeenTool seen_tool(const stages::Walk& walk, const CommonState& state, const Contact* contact) noexcept {
  const DisplayRig& rig = walk.scene.display;
  if (rig.tip == SeenTip::tracked) return {walk.X_WT_newest, walk.tip_newest};
  if (rig.tip == SeenTip::predicted || !walk.tool_known) return {walk.X_WT, walk.tool_tip};
  const Point<'W'> free = free_tip_ahead(walk, state);
  Vec<'W'> shift = free - walk.tool_tip;
  if (contact != nullptr && state.mode == Mode::contact && walk.felt.finite() && walk.X_WH.valid()) {
    // Use the force before the low-pass: the filtered force would hold back a tool that has left.
    const double force = -dot(walk.felt, contact->X_WN * Vec<'N'>(0, 0, 1));
    const double apart = walk.tool_radius + walk.scene.tip_radius - rig.compliance * std::max(0.0, force);
    // The direction is the present one, the position the extrapolated one.
    const Vec<'W'> beside = touching(walk.X_WH.origin(), apart, walk.tool_tip) - walk.X_WH.origin();
    const double share = pressing_share(force, walk.scene.force.contact);
    shift = shift + share * (haptic_tip_ahead(walk, state, *contact) + beside - free);
  }
  return {{walk.X_WT.q(), walk.X_WT.origin() + shift}, walk.tool_tip + shift};
}

}  // namespace enc

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
  // Also in a hold: opening the jaws would drop the tool.
  if (walk.scene.clamped_tool >= 0) out.grip = {true, walk.scene.grip_force};
  out.tip = Pose<'R', 'H'>(walk.scene.X_WR.q().conjugate(), now.command);
}

}  // namespace enc::stages
