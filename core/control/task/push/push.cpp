#include "core/control/task/push/push.h"

#include "core/base/rotation.h"
#include "core/control/stages/walk.h"

namespace enc::stages {
namespace {

// Criteria for a struck ball: each with its unit, its meaning and its confidence. "Behind" and "faster" are
// relative to the arm's target. User settings are in the rig file (rendering_rig.h) and in the table of
// interactions.
struct StrikeSpec {
  // m: region of a finger that is tracked with delay (assumed: a picture of it is 50 ms old).
  static constexpr double kNear = 0.030;
  // m/s: the prop moves faster than noise can explain (derived: two counts of an encoder in 2 ms are 0.014).
  static constexpr double kSpeed = 0.025;
  // m: the prop was moved (derived: two counts).
  static constexpr double kMoved = 0.06e-3;
  // m: largest distance at which friction holds the prop off the surface (assumed: no source).
  static constexpr double kFriction = 0.6e-3;
  // s: time from the arm's arrival to its rest (assumed: no source).
  static constexpr double kSettled = 0.100;
  // s: lag of a moving arm behind its target (assumed: no source).
  static constexpr double kLate = 0.004;
  // Share of the target's speed by which the arm's may differ (assumed: no source).
  static constexpr double kUneven = 0.12;
  // N: a smaller force is lost in the arm's friction (assumed: no source).
  static constexpr double kFelt = 0.05;
  // s: a strike without force for this time is over (assumed: no source).
  static constexpr double kEmpty = 0.10;
  // m: a prop that returns to this distance behind its strike was not pushed by a finger (assumed: three
  // counts).
  static constexpr double kBack = 0.1e-3;
};

// True if the prop, standing at the surface, is struck: pushed in faster and farther than noise explains, and
// than an arm lags that was just sent somewhere. Vision only shows that a finger may be there. Motion of the
// arm on its way home is no strike.
bool struck(const Walk& walk, const CommonState& state, Meeting& now) {
  using Is = StrikeSpec;
  const double behind = dot(now.aim.target - walk.X_WH.origin(), walk.normal);
  const double speed = dot(now.aim.velocity - walk.tip_velocity, walk.normal);
  const bool there = state.mode == Mode::follow && now.aim.caught_up && walk.tool_known;
  const double fastest = now.aim.straying.fastest;  // of late
  const bool pushed = behind > Is::kFriction + Is::kLate * fastest ||
                      (behind > Is::kMoved && speed > Is::kSpeed + Is::kUneven * fastest);
  if (!there) now.contact.left = walk.tick.t;
  return there && age(walk.tick.t, now.contact.left) > Is::kSettled && pushed && walk.gap < Is::kNear;
}

// The prop shows how a ball is hit, each tick to 0.03 mm; a picture of the finger is 50 ms old, and by then
// the hit is over. So the depth is that of the prop behind the point of the strike. It ends when they part,
// when no force was detected for a while, or when the ball is at its waiting position. A ball cannot be hit
// again before it is back.
double hit_depth(Walk& walk, CommonState& state, Meeting& memory, const Mover& mover, const Moved& now) {
  Contact& contact = memory.contact;
  const bool pressed = state.mode == Mode::contact && contact.anchored && contact.object == state.object;
  if (!pressed) {
    const bool home = now.shift.e().isZero() && now.velocity.e().isZero();
    if (!home || !struck(walk, state, memory)) return kUnset;
    contact = Contact{};
    contact.object = state.object;
    contact.tool = state.tool.value.tool;
    contact.anchored = true;
    contact.began = walk.tick.t;
    contact.X_WN = Pose<'W', 'N'>(rotation_z_to(walk.normal.e()), walk.X_WH.origin());
    state.mode = Mode::contact;
    ++state.contacts;
  }
  walk.normal = contact.X_WN * Vec<'N'>(0, 0, 1);
  const double depth = dot(contact.X_WN.origin() + now.shift - walk.X_WH.origin(), walk.normal);
  const bool felt = mover.stiffness * now.firmness * depth > StrikeSpec::kFelt;
  contact.clear = felt ? 0.0 : contact.clear + walk.scene.dt;
  const bool gone = now.shift.norm() >= mover.travel * (1.0 - 1e-9);
  const bool apart = depth < -StrikeSpec::kBack || (!(depth > 0.0) && now.deepest > 0.0);
  if (apart || gone || contact.clear > StrikeSpec::kEmpty) {
    contact.anchored = false;
    contact.left = walk.tick.t;
  }
  walk.gap = -depth;
  return contact.anchored ? depth : kUnset;
}

// Time also stands still here in a hold.
void push(Walk& walk, CommonState& state, Pushing& now) {
  if (holding(walk)) {
    now.contact.anchored = false;
    return;
  }
  double depth = -walk.gap, sinks = 0.0;
  if (state.object >= 0) {
    const Object& object = walk.scene.objects[static_cast<std::size_t>(state.object)];
    if (object.interaction.kind == Interaction::hit)
      depth = hit_depth(walk, state, now, walk.movers[static_cast<std::size_t>(object.moving)],
                        walk.moved[static_cast<std::size_t>(object.moving)]);
    if (object.interaction.kind == Interaction::shift && state.mode == Mode::contact)
      sinks =
          dot(walk.moved[static_cast<std::size_t>(object.moving)].velocity - walk.tip_velocity, walk.normal);
  }
  const double speed = -dot(now.aim.velocity, walk.normal);  // a struck prop: go_with
  const bool late = age(walk.tick.t, now.contact.left) < walk.scene.tracker.usual_age;
  const FingerPress press{state.object,     depth, walk.normal, walk.tool_tip,
                          walk.tool_radius, speed, sinks,       late};
  move(walk.movers, press, walk.scene.dt, walk.moved);
}

}  // namespace

void track(Walk& walk, const Push& task, CommonState& state, Pushing& now) noexcept {
  walk.moved = now.moved;
  walk.movers = task.movers;
  track(walk, static_cast<const Impedance&>(task), state, now);
}

void act(Walk& walk, const Push& task, CommonState& state, Pushing& now) noexcept {
  push(walk, state, now);
  act(walk, static_cast<const Impedance&>(task), state, now);
}

}  // namespace enc::stages
