// Force on the haptic-tip: zero error, weight and inertia of what is behind the sensor taken out, then
// low-passed. [VHMR 3.4]
#include <algorithm>

#include "core/task/walk.h"

namespace enc::stages {
namespace {

constexpr double kGravity = 9.80665;   // m/s^2, along -z of W
constexpr double kAbsurd = 1e4;        // N, N m: no sensor of this kind reads more
constexpr double kFreeTareTime = 2.0;  // s: how slowly the zero follows while the tool is clear

bool at_rest(const Probing& probing) {
  return probing.phase == ProbePhase::wait || probing.phase == ProbePhase::rest ||
         probing.phase == ProbePhase::done;
}

// Whether nothing can be on the tip, so that what the sensor says is its zero. A tool that is not seen now
// may be anywhere, and in a hold nothing is as it should be: then nothing is learnt.
bool clear_of_object(const Walk& walk, const State& state) {
  if (holding(walk) || state.held) return false;
  if (walk.scene.probe) return at_rest(state.probing) && walk.gap > walk.scene.force.tare_clearance;
  if (walk.scene.travel) return state.travelling.phase != TravelPhase::move;
  if (state.mode != Mode::away && state.mode != Mode::follow) return false;
  if (!walk.scene.has_tracker) return true;
  return walk.tool_known && walk.tool_fresh && walk.gap > walk.scene.force.tare_clearance;
}

// The zero is the mean of the last window but one: no part of a touch is in it, however slowly it begins.
void tare_again(const Walk& walk, const Vec<'F'>& unloaded, bool clear, State& state) {
  if (state.tare_window == 0.0 || !clear) state.tare_mean = Vec<'F'>::zero();
  if (!clear) {
    state.tare_last = Vec<'F'>();
    state.tare_window = 0.0;
    return;
  }
  state.tare_window += walk.scene.dt;
  state.tare_mean = state.tare_mean + (walk.scene.dt / state.tare_window) * (unloaded - state.tare_mean);
  if (state.tare_window < walk.scene.force.tare_time) return;
  if (state.tare_last.finite()) state.force_zero = state.tare_last;
  state.tare_last = state.tare_mean;
  state.tare_window = 0.0;
}

// The running mean of the first tare_time becomes the zero; after that it is as the rig says.
void tare(const Walk& walk, const Vec<'F'>& unloaded, State& state) {
  const ForceRig& rig = walk.scene.force;
  const bool clear = clear_of_object(walk, state);
  const bool first = state.tared < rig.tare_time;
  if (!first && rig.tare == Tare::window) return tare_again(walk, unloaded, clear, state);
  if (!clear || (!first && rig.tare == Tare::start)) return;
  state.tared += walk.scene.dt;
  const double gain = walk.scene.dt / (first ? state.tared : kFreeTareTime);
  state.force_zero = state.force_zero + gain * (unloaded - state.force_zero);
}

}  // namespace

void sense(Walk& walk, State& state) noexcept {
  if (!walk.scene.has_force) return;
  const auto& sample = walk.in.wrench;
  if (sample.health == Health::absent || age(walk.tick.t, sample.t) > walk.scene.force.stale) {
    walk.why |= kForceLost;
    return;
  }
  const bool absurd = !sample.value.force.finite() || !sample.value.torque.finite() ||
                      sample.value.force.norm() > kAbsurd || sample.value.torque.norm() > kAbsurd ||
                      sample.t > walk.tick.t + walk.tick.dt;
  if (absurd || sample.health == Health::fault) {
    walk.why |= kForceInvalid;
    return;
  }
  if (sample.health == Health::saturated || sample.health == Health::out_of_range)
    walk.why |= kForceSaturated;
  if ((walk.why & (kTipInvalid | kTipLost | kForceSaturated)) != 0) return;

  // measured = contact + m g - m a + zero
  const Pose<'W', 'F'> X_WF = walk.X_WH * walk.scene.X_HF;
  const Vec<'W'> acceleration = walk.scene.X_WR * walk.in.tip.value.acceleration;
  const Vec<'W'> dead_load = walk.scene.force.mass * (Vec<'W'>(0, 0, -kGravity) - acceleration);
  const Vec<'F'> unloaded = sample.value.force - X_WF.inverse() * dead_load;
  tare(walk, unloaded, state);
  if (state.tared < walk.scene.force.tare_time) {
    walk.why |= kTaring;
    return;
  }
  walk.felt = X_WF * (unloaded - state.force_zero);
  state.force = state.force + walk.scene.filter_gain * (walk.felt - state.force);
  walk.force = state.force;
}

}  // namespace enc::stages
