#include "core/control/stages/displacing.h"

#include <cmath>

#include "core/control/stages/walk.h"

namespace enc::stages {
namespace {

// m, m/s, m/s^2: a sample beyond these is wrong (assumed: a hundred times a machine's reach and speed).
constexpr double kFarthest = 10.0, kFastest = 10.0, kMostAcceleration = 1e3;
// rad: a machine turned by more must be turned back by its own means first (assumed: no source).
constexpr double kTurned = 2e-3;
// m and N: jaws that are open farther or press harder are wrong (assumed: a hundred times any gripper).
constexpr double kWidestJaws = 1.0, kMostGrip = 1e4;
// m: the machine is back where its command is (assumed: no source).
constexpr double kBack = 1e-3;

// Nothing is said to the machine before it has said where it is, and nothing goes on where it was.
void begin_anew(CommonState& state, Commanded& now) {
  state.started = false;
  state.entered = false;
  state.mode = Mode::away;
  now.command = Point<'R'>();
  now.command_velocity = Vec<'R'>::zero();
  now.following = Following{};
}

void track_tip(Walk& walk, CommonState& state, Commanded& now) {
  const auto& sample = walk.in.tip;
  if (sample.health == Health::absent || age(walk.tick.t, sample.t) > walk.scene.force.stale) {
    walk.why |= kTipLost;
    return;
  }
  const auto& tip = sample.value;
  const bool usable = (sample.health == Health::ok || sample.health == Health::out_of_range) &&
                      tip.X_RH.valid() && tip.X_RH.p().norm() < kFarthest && tip.velocity.finite() &&
                      tip.acceleration.finite() && tip.acceleration.norm() < kMostAcceleration &&
                      tip.velocity.norm() < kFastest && sample.t <= walk.tick.t + walk.tick.dt;
  if (!usable) {
    walk.why |= kTipInvalid;
    return;
  }
  walk.X_WH = walk.scene.X_WR * tip.X_RH;
  if (!state.started) {
    // Commands keep W's axes: a machine that stands turned must be turned back by its own means first.
    if (walk.X_WH.q().angularDistance(Quat::Identity()) > kTurned) {
      walk.why |= kTipInvalid;
      return;
    }
    state.started = true;
    now.command = tip.X_RH.origin();
  }
  // What is withheld needs no following, and is forgotten.
  if (walk.in.withheld)
    now.following = Following{};
  else if (!follows(walk.scene.servo, now.command, now.command_velocity, tip.X_RH.origin(), now.following))
    now.following.lost = true;
}

}  // namespace

void track(Walk& walk, const Displacing&, CommonState& state, Commanded& now) noexcept {
  walk.stops_tool = true;
  if (walk.in.resumed) begin_anew(state, now);
  if (walk.scene.has_manipulator) track_tip(walk, state, now);
  track_tool(walk, state, false);
}

void grip(Walk& walk) noexcept {
  if (walk.scene.clamped_tool < 0) return;
  const Stamped<GripSample>& sample = walk.in.grip;
  const GripSample& jaws = sample.value;
  const bool possible = std::abs(jaws.opening) < kWidestJaws &&
                        std::abs(jaws.force) < kMostGrip &&  // false for NaN
                        sample.t <= walk.tick.t + walk.tick.dt;
  const bool usable = sample.health == Health::ok || sample.health == Health::out_of_range;
  const bool empty = jaws.phase == GripPhase::closed && !jaws.holding;
  if (!possible || !usable || empty || age(walk.tick.t, sample.t) > walk.scene.force.stale)
    walk.why |= kToolNotHeld;
}

// A machine that did not follow may go on at any time: the hold lasts until the tool has gone and the command
// is back where the machine is; where nobody sees a tool, to the end.
void hold_lost(Walk& walk, CommonState& state, Commanded& now) noexcept {
  if (!now.following.lost) return;
  const bool back = (walk.X_WH.origin() - walk.scene.X_WR * now.command).norm() < kBack;  // false for NaN
  const bool gone =
      walk.scene.has_tracker && walk.tool_known && walk.tool_fresh && walk.gap > walk.scene.follow.pause;
  if (gone && back) {
    now.following = Following{};
    state.mode = Mode::away;
  } else {
    walk.why |= kNotFollowing;
  }
}

}  // namespace enc::stages
