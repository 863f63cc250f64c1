// Force on the haptic-tip: zero error, weight and inertia of what is behind the sensor taken out, then
// low-passed. [VHMR 3.4]
#include <algorithm>

#include "core/control/stages/displacing.h"
#include "core/control/stages/walk.h"
#include "core/machine/arm.h"

namespace enc::stages {
namespace {

constexpr double kAbsurd = 1e4;        // N, N m: no sensor of this kind reads more
constexpr double kFreeTareTime = 2.0;  // s: how slowly the zero follows while the tool is clear

// The zero is the mean of the last window but one: no part of a touch is in it, however slowly it begins.
void tare_again(const Walk& walk, const Vec<'F'>& unloaded, bool clear, Commanded& now) {
  if (now.tare_window == 0.0 || !clear) now.tare_mean = Vec<'F'>::zero();
  if (!clear) {
    now.tare_last = Vec<'F'>();
    now.tare_window = 0.0;
    return;
  }
  now.tare_window += walk.scene.dt;
  now.tare_mean = now.tare_mean + (walk.scene.dt / now.tare_window) * (unloaded - now.tare_mean);
  if (now.tare_window < walk.scene.force.tare_time) return;
  if (now.tare_last.finite()) now.force_zero = now.tare_last;
  now.tare_last = now.tare_mean;
  now.tare_window = 0.0;
}

// The running mean of the first tare_time becomes the zero; after that it is as the rig says.
void tare(const Walk& walk, const Vec<'F'>& unloaded, bool clear, Commanded& now) {
  const ForceRig& rig = walk.scene.force;
  const bool first = now.tared < rig.tare_time;
  if (!first && rig.tare == Tare::window) return tare_again(walk, unloaded, clear, now);
  if (!clear || (!first && rig.tare == Tare::start)) return;
  now.tared += walk.scene.dt;
  const double gain = walk.scene.dt / (first ? now.tared : kFreeTareTime);
  now.force_zero = now.force_zero + gain * (unloaded - now.force_zero);
}

}  // namespace

// A tool that is not seen may be anywhere, and in a hold nothing is as it should be: then nothing is learnt.
void sense(Walk& walk, CommonState& state, Commanded& now, bool clear) noexcept {
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
  const Vec<'W'> dead_load = walk.scene.force.mass * (Vec<'W'>(0, 0, -kStandardGravity) - acceleration);
  const Vec<'F'> unloaded = sample.value.force - X_WF.inverse() * dead_load;
  tare(walk, unloaded, clear && !holding(walk) && !state.held, now);
  if (now.tared < walk.scene.force.tare_time) {
    walk.why |= kTaring;
    return;
  }
  walk.felt = X_WF * (unloaded - now.force_zero);
  state.force = state.force + walk.scene.filter_gain * (walk.felt - state.force);
  walk.force = state.force;
}

}  // namespace enc::stages
