#include "core/control/task/dynamic_object/dynamic_object.h"

#include "core/base/rotation.h"

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
bool struck(const ArmContext& context, const CommonState& state, ImpedanceState& now) {
  using Is = StrikeSpec;
  const double behind = dot(now.aim.target - context.X_WH.origin(), context.normal);
  const double speed = dot(now.aim.velocity - context.tip_velocity, context.normal);
  const bool there = state.mode == Mode::follow && now.aim.caught_up && context.tool_known;
  const double fastest = now.aim.deviation.fastest;  // of late
  const bool pushed = behind > Is::kFriction + Is::kLate * fastest ||
                      (behind > Is::kMoved && speed > Is::kSpeed + Is::kUneven * fastest);
  if (!there) now.contact.left = context.tick.t;
  return there && age(context.tick.t, now.contact.left) > Is::kSettled && pushed && context.gap < Is::kNear;
}

// The prop shows how a ball is hit, each tick to 0.03 mm; a picture of the finger is 50 ms old, and by then
// the hit is over. So the depth is that of the prop behind the point of the strike. It ends when they part,
// when no force was detected for a while, or when the ball is at its waiting position. A ball cannot be hit
// again before it is back.
double hit_depth(ArmContext& context, CommonState& state, ImpedanceState& memory, const Mover& mover,
                 const MoverState& now) {
  Contact& contact = memory.contact;
  const bool pressed = state.mode == Mode::contact && contact.anchored && contact.object == state.object;
  if (!pressed) {
    const bool home = now.shift.e().isZero() && now.velocity.e().isZero();
    if (!home || !struck(context, state, memory)) return kUnset;
    contact = Contact{};
    contact.object = state.object;
    contact.tool = state.tool.value.tool;
    contact.anchored = true;
    contact.began = context.tick.t;
    contact.X_WN = Pose<'W', 'N'>(rotation_z_to(context.normal.e()), context.X_WH.origin());
    state.mode = Mode::contact;
    ++state.contacts;
  }
  context.normal = contact.X_WN * Vec<'N'>(0, 0, 1);
  const double depth = dot(contact.X_WN.origin() + now.shift - context.X_WH.origin(), context.normal);
  const bool felt = mover.stiffness * now.firmness * depth > StrikeSpec::kFelt;
  contact.clear = felt ? 0.0 : contact.clear + context.scene.dt;
  const bool gone = now.shift.norm() >= mover.travel * (1.0 - 1e-9);
  const bool apart = depth < -StrikeSpec::kBack || (!(depth > 0.0) && now.deepest > 0.0);
  if (apart || gone || contact.clear > StrikeSpec::kEmpty) {
    contact.anchored = false;
    contact.left = context.tick.t;
  }
  context.gap = -depth;
  return contact.anchored ? depth : kUnset;
}

// Time also stands still here in a hold.
void push(ArmContext& context, CommonState& state, DynamicObjectState& now) {
  if (holding(context)) {
    now.contact.anchored = false;
    return;
  }
  double depth = -context.gap, sinks = 0.0;
  if (state.object >= 0) {
    const Object& object = context.scene.objects[static_cast<std::size_t>(state.object)];
    if (object.interaction.kind == Interaction::hit)
      depth = hit_depth(context, state, now, context.movers[static_cast<std::size_t>(object.moving)],
                        context.moved[static_cast<std::size_t>(object.moving)]);
    if (object.interaction.kind == Interaction::shift && state.mode == Mode::contact)
      sinks = dot(context.moved[static_cast<std::size_t>(object.moving)].velocity - context.tip_velocity,
                  context.normal);
  }
  const double speed =
      -dot(now.aim.velocity, context.normal);  // a struck prop: go_with_prop in impedance/aim.cpp
  const bool late = age(context.tick.t, now.contact.left) < context.scene.tracker.usual_age;
  const FingerPress press{state.object,        depth, context.normal, context.tool_tip,
                          context.tool_radius, speed, sinks,          late};
  move(context.movers, press, context.scene.dt, context.moved);
}

}  // namespace

void track(ArmContext& context, const DynamicObjectTask& task, CommonState& state,
           DynamicObjectState& now) noexcept {
  context.moved = now.moved;
  context.movers = task.movers;
  track(context, static_cast<const Impedance&>(task), state, now);
}

void act(ArmContext& context, const DynamicObjectTask& task, CommonState& state,
         DynamicObjectState& now) noexcept {
  push(context, state, now);
  act(context, static_cast<const Impedance&>(task), state, now);
}

}  // namespace enc::stages
