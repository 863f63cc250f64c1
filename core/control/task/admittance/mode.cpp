// The mode of the machine [VHMR 3.3, 3.4]. Hysteresis everywhere: one press is one contact, whatever the
// noise.
#include <cmath>

#include "core/base/rotation.h"
#include "core/control/task/admittance/admittance_task.h"

namespace enc::stages {
namespace {

double pressing_force(const AdmittanceContext& context, const Vec<'W'>& normal) {
  return context.force.finite() ? -dot(context.force, normal) : 0.0;
}

// A tool this far away presses nothing, whatever the force: the zero has drifted, and only free space can
// correct it. The value exceeds the motion of a tool at 200 mm/s during the tracker's latency.
constexpr double kFar = 10e-3;  // m
// Longest time for which a mode may outlive its cause (mode.h).
constexpr double kMeeting = 0.5, kReturning = 5.0, kRestoring = 2.0, kUnseen = 5.0, kUnseenLong = 60.0;  // s
// A force is steady within this share of the contact threshold, and small up to this multiple of it.
constexpr double kSteady = 0.15, kSmall = 3.0;
bool too_far(const AdmittanceContext& context) { return context.tool_known && context.gap > kFar; }

// A pressing hand cannot change its tool. Another tool in view did not make this contact, and its position is
// no evidence. Then force alone keeps the contact and ends it.
bool changed_tool(const AdmittanceContext& context, const CommonState& state, const AdmittanceState& now) {
  return context.tool_known && state.tool.value.tool != now.contact.tool;
}

// True if the scene has a tracker and the tracker sees no known tool.
bool nothing_seen(const AdmittanceContext& context) {
  return context.scene.has_tracker && !context.tool_known;
}

// Force without a cause is an error of the sensor's zero. Either the contact's own tool is seen clear of the
// object, or that tool is out of view and the force is steadier than a hand can keep it. The latter must last
// a while if the force is small and the tool in view is clear, and a minute otherwise. A late pose neither
// counts nor resets the count.
bool force_is_drift(const AdmittanceContext& context, bool own, double force, Contact& contact) {
  if (!context.scene.has_tracker) return false;
  if (context.tool_known && !context.tool_fresh) return false;
  const double threshold = context.scene.force.contact;
  const bool clear = !context.tool_known || context.gap > context.scene.force.tare_clearance;
  const bool steady = std::abs(force - static_cast<double>(contact.steady_force)) <= kSteady * threshold;
  const bool changed = contact.unseen == own;
  const bool goes_on = own ? clear : steady;
  contact.unseen = !own;
  if (changed || (!own && !steady)) contact.steady_force = static_cast<float>(force);
  contact.clear = goes_on && !changed ? contact.clear + context.scene.dt : 0.0;
  const double longest = own ? kMeeting : clear && force <= kSmall * threshold ? kUnseen : kUnseenLong;
  return contact.clear >= longest;
}

// m/s: machine and command stand still (assumed: no source).
constexpr double kStandstill = 1e-5;
// True if the machine is as near to the buffered point as it gets.
bool at_rest(const AdmittanceContext& context, const AdmittanceState& now) {
  return now.command_velocity.norm() < kStandstill && context.in.tip.value.velocity.norm() < kStandstill;
}

// The surface point under the tool; without a tracker, over the tip.
Pose<'W', 'N'> frame_under_tool(const AdmittanceContext& context, const CommonState& state) {
  if (context.tool_known) return {rotation_z_to(context.normal.e()), context.surface_point};
  const Pose<'W', 'O'>& X_WO = context.scene.objects[static_cast<std::size_t>(state.object)].X_WO;
  return {rotation_z_to((X_WO * context.at_tip.normal).e()), X_WO * context.at_tip.point};
}

// Distance of the tip from its place under the tool, along the surface, m.
double beside_tool(const AdmittanceContext& context, const AdmittanceState& now) {
  return (now.contact.X_WN.inverse() * context.X_WH.origin()).e().head<2>().norm();
}
constexpr double kUnder = 0.5e-3;  // m: a nearer tip is under its tool

void begin_contact(AdmittanceContext& context, CommonState& state, AdmittanceState& now, bool by_force) {
  state.mode = Mode::contact;
  ++state.contacts;
  if (now.contact.object != state.object)
    now.spent = RenderedEnergy{};  // a contact with another object starts anew
  now.contact = Contact{};
  rest(now);
  now.contact.object = state.object;
  now.contact.tool = context.tool_known ? state.tool.value.tool : -1;
  now.contact.X_WN = frame_under_tool(context, state);
  now.contact.began = context.tick.t;
  // Too far to the side to meet its tool from below: the tip would meet it from the side and push it along.
  now.contact.below = !by_force && context.tool_known &&
                      beside_tool(context, now) > context.scene.tip_radius + context.tool_radius;
  if (!by_force) return;
  now.contact.loaded = context.tick.t;
  context.why |= kByForce;
}

// Until force is measured with the tip under the tool, the anchor follows the tool. A fast or slanted touch
// meets the tip beside its middle, and a tip that stayed there would be pushed out from under the tool.
void anchor(AdmittanceContext& context, const CommonState& state, AdmittanceState& now) {
  now.contact.X_WN = frame_under_tool(context, state);
  const double force = pressing_force(context, now.contact.X_WN * Vec<'N'>(0, 0, 1));
  const bool under = beside_tool(context, now) <= kUnder, felt = force >= context.scene.force.contact;
  now.contact.anchored = felt && under;
  now.contact.below = now.contact.below && context.tool_known && !felt && !under;
}

void in_contact(AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
                AdmittanceState& now) {
  const bool changed = changed_tool(context, state, now);
  if (!now.contact.anchored && !changed) anchor(context, state, now);
  const double force = pressing_force(context, now.contact.X_WN * Vec<'N'>(0, 0, 1));
  // If another tool is in view, only the force supports the contact, so it must reach the full threshold.
  const double least = (changed ? 1.0 : 0.5) * context.scene.force.contact;
  const bool own = context.tool_known && !changed;
  const bool drifted = force_is_drift(context, own, force, now.contact);
  if (drifted && own && force >= least) now.tared = 0.0;  // learnt anew
  if (force >= least && !drifted && (changed || !too_far(context))) now.contact.loaded = context.tick.t;
  const double without = age(context.tick.t, now.contact.loaded);  // force, s
  // Behind a damper the tip comes back slowly; the tool that pushed it may wait there.
  const bool returning = task.damping && !too_far(context) && without < kReturning &&
                         -now.displacement.xyz[2] > context.scene.contact.leave_gap;
  const bool unloaded = !returning && without >= context.scene.contact.leave_time;
  // The tool has slid off: it is beside the tip, where the two can no longer touch.
  const double beside = context.tool_known ? (context.surface_point - now.contact.X_WN.origin()).norm() : 0.0;
  const bool slid_off = beside > context.scene.tip_radius + context.tool_radius;
  // Before any force was measured the tool may not have arrived: the prediction runs too far ahead of a tool
  // that slows down. Ending the contact before that touch would make two contacts of one press.
  const bool felt = now.contact.loaded > Time{} || age(context.tick.t, now.contact.began) >= kMeeting;
  const double leave = felt ? context.scene.contact.leave_gap : kFar;
  const bool gone = !context.tool_known || changed || context.gap > leave || slid_off;
  if (!unloaded || !gone) return;
  state.mode = Mode::restore;
  now.contact.left = context.tick.t;
}

void in_free_space(AdmittanceContext& context, CommonState& state, AdmittanceState& now) {
  const FollowSpec& follow = context.scene.follow;
  if (nothing_seen(context)) {
    state.mode = Mode::away;
    return;
  }
  if (state.mode == Mode::away && (!context.scene.has_tracker || context.gap < follow.resume))
    state.mode = Mode::follow;
  if (state.mode == Mode::follow && context.gap > follow.pause) state.mode = Mode::away;
  // Without the force zero the tip could not give way: the user must first take the tool away.
  if (state.mode != Mode::follow || !context.scene.has_force || (context.why & kTaring) != 0) return;
  if (context.gap <= 0.0) {
    begin_contact(context, state, now, false);
  } else if (pressing_force(context, context.normal) >= context.scene.force.contact && !too_far(context)) {
    begin_contact(context, state, now, true);
  }
}

}  // namespace

void mode(AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
          AdmittanceState& now) noexcept {
  if (state.object < 0) {
    state.mode = Mode::away;
  } else if (state.mode == Mode::contact) {
    in_contact(context, task, state, now);
  } else if (state.mode == Mode::restore) {
    const Point<'W'> buffered = now.contact.X_WN * Point<'N'>(0, 0, -context.scene.tip_radius - kSkin);
    const Vec<'W'> normal = now.contact.X_WN * Vec<'N'>(0, 0, 1);
    if (pressing_force(context, normal) >= context.scene.force.contact && !too_far(context) &&
        !nothing_seen(context)) {
      begin_contact(context, state, now, true);  // the user pressed again before the tip was back
    } else if ((context.X_WH.origin() - buffered).norm() <= context.scene.contact.restored ||
               at_rest(context, now) || age(context.tick.t, now.contact.left) >= kRestoring) {
      state.mode = nothing_seen(context) ? Mode::away : Mode::follow;
    }
  } else {
    in_free_space(context, state, now);
  }
}

}  // namespace enc::stages
