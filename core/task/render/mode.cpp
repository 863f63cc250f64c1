// Which mode the machine is in [VHMR 3.3, 3.4]. Hysteresis everywhere: one press is one contact, whatever the
// noise.
#include "core/rotation.h"
#include "core/task/walk.h"

namespace enc::stages {
namespace {

double pressing_force(const Walk& walk, const Vec<'W'>& normal) {
  return walk.force.finite() ? -dot(walk.force, normal) : 0.0;
}

// A tool this far away presses nothing, whatever the force says: the zero has drifted, and only free space
// can mend that. Wider than what a tool at 200 mm/s moves while its pose is on the way.
constexpr double kFar = 10e-3;  // m
// How long a mode may outlive its cause (mode.h).
constexpr double kMeeting = 0.5, kReturning = 5.0, kRestoring = 2.0;  // s
bool too_far(const Walk& walk) { return walk.tool_known && walk.gap > kFar; }

// A hand that presses cannot change its tool: another one in view did not make this contact, and where it is
// says nothing of it. Then force alone holds the contact and ends it.
bool changed_tool(const Walk& walk, const State& state) {
  return walk.tool_known && state.tool.value.tool != state.contact.tool;
}

// As near to the buffered point as the machine gets.
bool at_rest(const Walk& walk, const State& state) {
  constexpr double kStill = 1e-5;  // m/s
  return state.command_velocity.norm() < kStill && walk.in.tip.value.velocity.norm() < kStill;
}

// The surface point under the tool; without a tracker, over the tip.
Pose<'W', 'N'> frame_under_tool(const Walk& walk, const State& state) {
  if (walk.tool_known) return {rotation_z_to(walk.normal.e()), walk.surface_point};
  const Pose<'W', 'O'>& X_WO = walk.scene.objects[static_cast<std::size_t>(state.object)].X_WO;
  return {rotation_z_to((X_WO * walk.at_tip.normal).e()), X_WO * walk.at_tip.point};
}

void begin_contact(Walk& walk, State& state, bool by_force) {
  state.mode = Mode::contact;
  ++state.contacts;
  state.contact = Contact{};
  state.contact.object = state.object;
  state.contact.tool = walk.tool_known ? state.tool.value.tool : -1;
  state.contact.X_WN = frame_under_tool(walk, state);
  state.contact.began = walk.tick.t;
  if (!by_force) return;
  state.contact.loaded = walk.tick.t;
  walk.why |= kByForce;
}

// Until force is felt with the tip under the tool, the anchor goes where the tool goes: a fast or slanted
// touch meets the tip beside its middle, and a tip that stayed there would be pushed out from under the tool.
void anchor(Walk& walk, State& state) {
  constexpr double kUnder = 0.5e-3;  // m
  state.contact.X_WN = frame_under_tool(walk, state);
  const double force = pressing_force(walk, state.contact.X_WN * Vec<'N'>(0, 0, 1));
  const Vec3 beside = (state.contact.X_WN.inverse() * walk.X_WH.origin()).e();
  state.contact.anchored = force >= walk.scene.force.contact && beside.head<2>().norm() <= kUnder;
}

void in_contact(Walk& walk, State& state) {
  const bool changed = changed_tool(walk, state);
  if (!state.contact.anchored && !changed) anchor(walk, state);
  const double force = pressing_force(walk, state.contact.X_WN * Vec<'N'>(0, 0, 1));
  // Nothing but the force speaks for the contact of a tool that is no longer seen: it has to be a whole one.
  const double least = (changed ? 1.0 : 0.5) * walk.scene.force.contact;
  // What is felt while the tool is seen to be clear for so long is an error of the zero, which is learnt
  // anew.
  const bool clear =
      walk.tool_known && walk.tool_fresh && !changed && walk.gap > walk.scene.force.tare_clearance;
  state.contact.clear = clear ? state.contact.clear + walk.scene.dt : 0.0;
  const bool drifted = state.contact.clear >= kMeeting;
  if (drifted && force >= least) state.tared = 0.0;
  if (force >= least && !drifted && (changed || !too_far(walk))) state.contact.loaded = walk.tick.t;
  const double without = age(walk.tick.t, state.contact.loaded);  // force, s
  // Behind a damper the tip comes back slowly; what pushed it may wait there.
  const bool returning = walk.scene.damping && !too_far(walk) && without < kReturning &&
                         -state.contact.displacement.xyz[2] > walk.scene.contact.leave_gap;
  const bool unloaded = !returning && without >= walk.scene.contact.leave_time;
  // Slid off: beside the tip, where the two can no longer touch.
  const double beside = walk.tool_known ? (walk.surface_point - state.contact.X_WN.origin()).norm() : 0.0;
  const bool slid_off = beside > walk.scene.tip_radius + walk.tool_radius;
  // Before any force was felt the tool may not be there yet: what slows down is predicted too far ahead. To
  // let go of it and then to be touched would make two contacts of one press.
  const bool felt = state.contact.loaded > Time{} || age(walk.tick.t, state.contact.began) >= kMeeting;
  const double leave = felt ? walk.scene.contact.leave_gap : kFar;
  const bool gone = !walk.tool_known || changed || walk.gap > leave || slid_off;
  if (!unloaded || !gone) return;
  state.mode = Mode::restore;
  state.contact.left = walk.tick.t;
}

void in_free_space(Walk& walk, State& state) {
  const FollowSpec& follow = walk.scene.follow;
  if (walk.scene.has_tracker && !walk.tool_known) {
    state.mode = Mode::away;
    return;
  }
  if (state.mode == Mode::away && (!walk.scene.has_tracker || walk.gap < follow.resume))
    state.mode = Mode::follow;
  if (state.mode == Mode::follow && walk.gap > follow.pause) state.mode = Mode::away;
  // Without the force's zero the tip could not give way: the tool has to be taken away first.
  if (state.mode != Mode::follow || !walk.scene.has_force || (walk.why & kTaring) != 0) return;
  if (walk.gap <= 0.0) {
    begin_contact(walk, state, false);
  } else if (pressing_force(walk, walk.normal) >= walk.scene.force.contact && !too_far(walk)) {
    begin_contact(walk, state, true);
  }
}

}  // namespace

void mode(Walk& walk, State& state) noexcept {
  if (state.object < 0) {
    state.mode = Mode::away;
  } else if (state.mode == Mode::contact) {
    in_contact(walk, state);
  } else if (state.mode == Mode::restore) {
    const Point<'W'> buffered = state.contact.X_WN * Point<'N'>(0, 0, -walk.scene.tip_radius - kSkin);
    const Vec<'W'> normal = state.contact.X_WN * Vec<'N'>(0, 0, 1);
    if (pressing_force(walk, normal) >= walk.scene.force.contact && !too_far(walk)) {
      begin_contact(walk, state, true);  // pressed again before the tip was back
    } else if ((walk.X_WH.origin() - buffered).norm() <= walk.scene.contact.restored ||
               at_rest(walk, state) || age(walk.tick.t, state.contact.left) >= kRestoring) {
      state.mode = Mode::follow;
    }
  } else {
    in_free_space(walk, state);
  }
}

}  // namespace enc::stages
