#include "core/control/stages/displacement.h"

#include <algorithm>
#include <cmath>

#include "core/machine/arm.h"

namespace enc::stages {
namespace {

// m, m/s, m/s^2: a sample beyond these is invalid (assumed: a hundred times a machine's reach and speed).
constexpr double kFarthest = 10.0, kFastest = 10.0, kMostAcceleration = 1e3;
// rad: a machine turned by more must first be turned back by its own means (assumed: no source).
constexpr double kTurned = 2e-3;
// m and N: jaws that are open farther or press harder are invalid (assumed: a hundred times any gripper).
constexpr double kWidestJaws = 1.0, kMostGrip = 1e4;
// m: the machine is back where its command is (assumed: no source).
constexpr double kBack = 1e-3;

// The core sends no command before the machine has reported its position, and starts from there.
void begin_anew(CommonState& state, CommandState& now) {
  state.started = false;
  state.entered = false;
  state.mode = Mode::away;
  now.command = Point<'R'>();
  now.command_velocity = Vec<'R'>::zero();
  now.following = FollowingState{};
}

void track_tip(ManipulatorContext& context, CommonState& state, CommandState& now) {
  const auto& sample = context.in.tip;
  if (sample.health == Health::absent || age(context.tick.t, sample.t) > context.scene.force.stale) {
    context.why |= kTipLost;
    return;
  }
  const auto& tip = sample.value;
  const bool usable = (sample.health == Health::ok || sample.health == Health::out_of_range) &&
                      tip.X_RH.valid() && tip.X_RH.p().norm() < kFarthest && tip.velocity.finite() &&
                      tip.acceleration.finite() && tip.acceleration.norm() < kMostAcceleration &&
                      tip.velocity.norm() < kFastest && sample.t <= context.tick.t + context.tick.dt;
  if (!usable) {
    context.why |= kTipInvalid;
    return;
  }
  context.X_WH = context.scene.X_WR * tip.X_RH;
  if (!state.started) {
    // Commands keep W's axes, so a turned machine must first be turned back by its own means.
    if (context.X_WH.q().angularDistance(Quat::Identity()) > kTurned) {
      context.why |= kTipInvalid;
      return;
    }
    state.started = true;
    now.command = tip.X_RH.origin();
  }
  // A withheld command needs no following check, so that check starts anew.
  if (context.in.withheld)
    now.following = FollowingState{};
  else if (!follows(context.scene.servo, now.command, now.command_velocity, tip.X_RH.origin(), now.following))
    now.following.lost = true;
}

}  // namespace

void track(ManipulatorContext& context, const DisplacementTask&, CommonState& state,
           CommandState& now) noexcept {
  if (context.in.resumed) begin_anew(state, now);
  if (context.scene.has_manipulator) track_tip(context, state, now);
  track_tool(context, state, {.stopped = true});
}

void grip(ManipulatorContext& context) noexcept {
  if (context.scene.clamped_tool < 0) return;
  const Measurement<GripSample>& sample = context.in.grip;
  const GripSample& jaws = sample.value;
  const bool possible = std::abs(jaws.opening) < kWidestJaws &&
                        std::abs(jaws.force) < kMostGrip &&  // false for NaN
                        sample.t <= context.tick.t + context.tick.dt;
  const bool usable = sample.health == Health::ok || sample.health == Health::out_of_range;
  const bool empty = jaws.phase == GripPhase::closed && !jaws.holding;
  if (!possible || !usable || empty || age(context.tick.t, sample.t) > context.scene.force.stale)
    context.why |= kToolNotHeld;
}

// A machine that did not follow may move on at any time. The hold lasts until the tool has gone and the
// command is back at the machine's position. Without a view of the tool it lasts to the end.
void hold_lost(ManipulatorContext& context, CommonState& state, CommandState& now) noexcept {
  if (!now.following.lost) return;
  const bool back =
      (context.X_WH.origin() - context.scene.X_WR * now.command).norm() < kBack;  // false for NaN
  const bool gone = context.scene.has_tracker && context.tool_known && context.tool_fresh &&
                    context.gap > context.scene.follow.pause;
  if (gone && back) {
    now.following = FollowingState{};
    state.mode = Mode::away;
  } else {
    context.why |= kNotFollowing;
  }
}

// ---- Force on the haptic-tip: the zero error, and the weight and inertia of the parts behind the sensor,
// are subtracted. The rest is low-passed [VHMR 3.4].

namespace {

constexpr double kAbsurd = 1e4;        // N, N m: no sensor of this kind measures more
constexpr double kFreeTareTime = 2.0;  // s: time constant of the zero while the tool is clear

// The zero is the mean of the last window but one, so it contains no part of a touch, however slowly that
// begins.
void tare_again(const ManipulatorContext& context, const Vec<'F'>& unloaded, bool clear, CommandState& now) {
  if (now.tare_window == 0.0 || !clear) now.tare_mean = Vec<'F'>::zero();
  if (!clear) {
    now.tare_last = Vec<'F'>();
    now.tare_window = 0.0;
    return;
  }
  now.tare_window += context.scene.dt;
  now.tare_mean = now.tare_mean + (context.scene.dt / now.tare_window) * (unloaded - now.tare_mean);
  if (now.tare_window < context.scene.force.tare_time) return;
  if (now.tare_last.finite()) now.force_zero = now.tare_last;
  now.tare_last = now.tare_mean;
  now.tare_window = 0.0;
}

// The running mean of the first tare_time becomes the zero; after that the rig's setting applies.
void tare(const ManipulatorContext& context, const Vec<'F'>& unloaded, bool clear, CommandState& now) {
  const ForceRig& rig = context.scene.force;
  const bool first = now.tared < rig.tare_time;
  if (!first && rig.tare == Tare::window) return tare_again(context, unloaded, clear, now);
  if (!clear || (!first && rig.tare == Tare::start)) return;
  now.tared += context.scene.dt;
  const double gain = context.scene.dt / (first ? now.tared : kFreeTareTime);
  now.force_zero = now.force_zero + gain * (unloaded - now.force_zero);
}

}  // namespace

// The force zero does not change while the tool is unseen or in a hold: the tool may be anywhere.
void sense(ManipulatorContext& context, CommonState& state, CommandState& now, bool clear) noexcept {
  if (!context.scene.has_force) return;
  const auto& sample = context.in.wrench;
  if (sample.health == Health::absent || age(context.tick.t, sample.t) > context.scene.force.stale) {
    context.why |= kForceLost;
    return;
  }
  const bool absurd = !sample.value.force.finite() || !sample.value.torque.finite() ||
                      sample.value.force.norm() > kAbsurd || sample.value.torque.norm() > kAbsurd ||
                      sample.t > context.tick.t + context.tick.dt;
  if (absurd || sample.health == Health::fault) {
    context.why |= kForceInvalid;
    return;
  }
  if (sample.health == Health::saturated || sample.health == Health::out_of_range)
    context.why |= kForceSaturated;
  if ((context.why & (kTipInvalid | kTipLost | kForceSaturated)) != 0) return;

  // measured = contact + m g - m a + zero
  const Pose<'W', 'F'> X_WF = context.X_WH * context.scene.X_HF;
  const Vec<'W'> acceleration = context.scene.X_WR * context.in.tip.value.acceleration;
  const Vec<'W'> dead_load = context.scene.force.mass * (Vec<'W'>(0, 0, -kStandardGravity) - acceleration);
  const Vec<'F'> unloaded = sample.value.force - X_WF.inverse() * dead_load;
  tare(context, unloaded, clear && !holding(context) && !state.held, now);
  if (now.tared < context.scene.force.tare_time) {
    context.why |= kTaring;
    return;
  }
  context.force_unfiltered = X_WF * (unloaded - now.force_zero);
  state.force = state.force + context.scene.filter_gain * (context.force_unfiltered - state.force);
  context.force = state.force;
}

}  // namespace enc::stages
