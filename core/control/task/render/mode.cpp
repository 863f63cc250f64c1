// The mode of the machine [VHMR 3.3, 3.4]. Hysteresis everywhere: one press is one contact, whatever the
// noise.
#include <cmath>

#include "core/base/rotation.h"
#include "core/control/stages/walk.h"
#include "core/control/task/render/render.h"

namespace enc::stages {
namespace {

double pressing_force(const Walk& walk, const Vec<'W'>& normal) {
  return walk.force.finite() ? -dot(walk.force, normal) : 0.0;
}

// A tool this far away presses nothing, whatever the force: the zero has drifted, and only free space can
// correct it. The value exceeds the motion of a tool at 200 mm/s during the tracker's latency.
constexpr double kFar = 10e-3;  // m
// Longest time for which a mode may outlive its cause (mode.h).
constexpr double kMeeting = 0.5, kReturning = 5.0, kRestoring = 2.0, kUnseen = 5.0, kUnseenLong = 60.0;  // s
// A force is steady within this share of the contact threshold, and small up to this multiple of it.
constexpr double kSteady = 0.15, kSmall = 3.0;
bool too_far(const Walk& walk) { return walk.tool_known && walk.gap > kFar; }

// A pressing hand cannot change its tool. Another tool in view did not make this contact, and its position is
// no evidence. Then force alone keeps the contact and ends it.
bool changed_tool(const Walk& walk, const CommonState& state, const Rendering& now) {
  return walk.tool_known && state.tool.value.tool != now.contact.tool;
}

// True if the scene has a tracker and the tracker sees no known tool.
bool nothing_seen(const Walk& walk) { return walk.scene.has_tracker && !walk.tool_known; }

// Force without a cause is an error of the sensor's zero. Either the contact's own tool is seen clear of the
// object, or that tool is out of view and the force is steadier than a hand can keep it. The latter must last
// a while if the force is small and the tool in view is clear, and a minute otherwise. A late pose neither
// counts nor resets the count.
bool force_is_drift(const Walk& walk, bool own, double force, Contact& contact) {
  if (!walk.scene.has_tracker) return false;
  if (walk.tool_known && !walk.tool_fresh) return false;
  const double threshold = walk.scene.force.contact;
  const bool clear = !walk.tool_known || walk.gap > walk.scene.force.tare_clearance;
  const bool steady = std::abs(force - static_cast<double>(contact.steady_force)) <= kSteady * threshold;
  const bool changed = contact.unseen == own;
  const bool goes_on = own ? clear : steady;
  contact.unseen = !own;
  if (changed || (!own && !steady)) contact.steady_force = static_cast<float>(force);
  contact.clear = goes_on && !changed ? contact.clear + walk.scene.dt : 0.0;
  const double longest = own ? kMeeting : clear && force <= kSmall * threshold ? kUnseen : kUnseenLong;
  return contact.clear >= longest;
}

// m/s: machine and command stand still (assumed: no source).
constexpr double kStandstill = 1e-5;
// True if the machine is as near to the buffered point as it gets.
bool at_rest(const Walk& walk, const Rendering& now) {
  return now.command_velocity.norm() < kStandstill && walk.in.tip.value.velocity.norm() < kStandstill;
}

// The surface point under the tool; without a tracker, over the tip.
Pose<'W', 'N'> frame_under_tool(const Walk& walk, const CommonState& state) {
  if (walk.tool_known) return {rotation_z_to(walk.normal.e()), walk.surface_point};
  const Pose<'W', 'O'>& X_WO = walk.scene.objects[static_cast<std::size_t>(state.object)].X_WO;
  return {rotation_z_to((X_WO * walk.at_tip.normal).e()), X_WO * walk.at_tip.point};
}

// Distance of the tip from its place under the tool, along the surface, m.
double beside_tool(const Walk& walk, const Rendering& now) {
  return (now.contact.X_WN.inverse() * walk.X_WH.origin()).e().head<2>().norm();
}
constexpr double kUnder = 0.5e-3;  // m: a nearer tip is under its tool

void begin_contact(Walk& walk, CommonState& state, Rendering& now, bool by_force) {
  state.mode = Mode::contact;
  ++state.contacts;
  if (now.contact.object != state.object) now.spent = Spent{};  // a contact with another object starts anew
  now.contact = Contact{};
  rest(now);
  now.contact.object = state.object;
  now.contact.tool = walk.tool_known ? state.tool.value.tool : -1;
  now.contact.X_WN = frame_under_tool(walk, state);
  now.contact.began = walk.tick.t;
  // Too far to the side to meet its tool from below: the tip would meet it from the side and push it along.
  now.contact.below =
      !by_force && walk.tool_known && beside_tool(walk, now) > walk.scene.tip_radius + walk.tool_radius;
  if (!by_force) return;
  now.contact.loaded = walk.tick.t;
  walk.why |= kByForce;
}

// Until force is measured with the tip under the tool, the anchor follows the tool. A fast or slanted touch
// meets the tip beside its middle, and a tip that stayed there would be pushed out from under the tool.
void anchor(Walk& walk, const CommonState& state, Rendering& now) {
  now.contact.X_WN = frame_under_tool(walk, state);
  const double force = pressing_force(walk, now.contact.X_WN * Vec<'N'>(0, 0, 1));
  const bool under = beside_tool(walk, now) <= kUnder, felt = force >= walk.scene.force.contact;
  now.contact.anchored = felt && under;
  now.contact.below = now.contact.below && walk.tool_known && !felt && !under;
}

void in_contact(Walk& walk, const Render& task, CommonState& state, Rendering& now) {
  const bool changed = changed_tool(walk, state, now);
  if (!now.contact.anchored && !changed) anchor(walk, state, now);
  const double force = pressing_force(walk, now.contact.X_WN * Vec<'N'>(0, 0, 1));
  // If another tool is in view, only the force supports the contact, so it must reach the full threshold.
  const double least = (changed ? 1.0 : 0.5) * walk.scene.force.contact;
  const bool own = walk.tool_known && !changed;
  const bool drifted = force_is_drift(walk, own, force, now.contact);
  if (drifted && own && force >= least) now.tared = 0.0;  // learnt anew
  if (force >= least && !drifted && (changed || !too_far(walk))) now.contact.loaded = walk.tick.t;
  const double without = age(walk.tick.t, now.contact.loaded);  // force, s
  // Behind a damper the tip comes back slowly; the tool that pushed it may wait there.
  const bool returning = task.damping && !too_far(walk) && without < kReturning &&
                         -now.displacement.xyz[2] > walk.scene.contact.leave_gap;
  const bool unloaded = !returning && without >= walk.scene.contact.leave_time;
  // The tool has slid off: it is beside the tip, where the two can no longer touch.
  const double beside = walk.tool_known ? (walk.surface_point - now.contact.X_WN.origin()).norm() : 0.0;
  const bool slid_off = beside > walk.scene.tip_radius + walk.tool_radius;
  // Before any force was measured the tool may not have arrived: the prediction runs too far ahead of a tool
  // that slows down. Ending the contact before that touch would make two contacts of one press.
  const bool felt = now.contact.loaded > Time{} || age(walk.tick.t, now.contact.began) >= kMeeting;
  const double leave = felt ? walk.scene.contact.leave_gap : kFar;
  const bool gone = !walk.tool_known || changed || walk.gap > leave || slid_off;
  if (!unloaded || !gone) return;
  state.mode = Mode::restore;
  now.contact.left = walk.tick.t;
}

void in_free_space(Walk& walk, CommonState& state, Rendering& now) {
  const FollowSpec& follow = walk.scene.follow;
  if (nothing_seen(walk)) {
    state.mode = Mode::away;
    return;
  }
  if (state.mode == Mode::away && (!walk.scene.has_tracker || walk.gap < follow.resume))
    state.mode = Mode::follow;
  if (state.mode == Mode::follow && walk.gap > follow.pause) state.mode = Mode::away;
  // Without the force zero the tip could not give way: the user must first take the tool away.
  if (state.mode != Mode::follow || !walk.scene.has_force || (walk.why & kTaring) != 0) return;
  if (walk.gap <= 0.0) {
    begin_contact(walk, state, now, false);
  } else if (pressing_force(walk, walk.normal) >= walk.scene.force.contact && !too_far(walk)) {
    begin_contact(walk, state, now, true);
  }
}

}  // namespace

void mode(Walk& walk, const Render& task, CommonState& state, Rendering& now) noexcept {
  if (state.object < 0) {
    state.mode = Mode::away;
  } else if (state.mode == Mode::contact) {
    in_contact(walk, task, state, now);
  } else if (state.mode == Mode::restore) {
    const Point<'W'> buffered = now.contact.X_WN * Point<'N'>(0, 0, -walk.scene.tip_radius - kSkin);
    const Vec<'W'> normal = now.contact.X_WN * Vec<'N'>(0, 0, 1);
    if (pressing_force(walk, normal) >= walk.scene.force.contact && !too_far(walk) && !nothing_seen(walk)) {
      begin_contact(walk, state, now, true);  // the user pressed again before the tip was back
    } else if ((walk.X_WH.origin() - buffered).norm() <= walk.scene.contact.restored || at_rest(walk, now) ||
               age(walk.tick.t, now.contact.left) >= kRestoring) {
      state.mode = nothing_seen(walk) ? Mode::away : Mode::follow;
    }
  } else {
    in_free_space(walk, state, now);
  }
}

}  // namespace enc::stages
