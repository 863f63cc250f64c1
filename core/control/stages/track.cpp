// Where the tool and the tip are at this tick: from the newest pose to now, its age judged. [VHMR 3.3]
#include <cmath>

#include "core/control/stages/walk.h"

namespace enc::stages {
namespace {

// It says how well it knows the place, or it says nothing of that.
bool tells_noise(const TrackedTool& tool, double most) {
  const auto possible = [most](double noise) { return noise >= 0.0 && noise < most; };
  const bool silent = std::isnan(tool.along) && std::isnan(tool.across);
  return silent || (possible(tool.along) && possible(tool.across));
}

bool plausible(const Walk& walk, const Stamped<TrackedTool>& sample) {
  const auto& tool = sample.value;
  return tells_noise(tool, walk.scene.tracker.farthest) && tool.X_CT.valid() &&
         tool.X_CT.p().norm() < walk.scene.tracker.farthest && tool.tool >= 0 &&
         tool.tool < static_cast<int>(walk.scene.tools.size()) && sample.t <= walk.tick.t + walk.tick.dt;
}

void judge_age(Walk& walk, const CommonState& state) {
  const double old = age(walk.tick.t, exposed(walk.scene.tracker, state.tool.t));
  walk.tool_fresh = old <= walk.scene.tracker.usual_age;
  if (walk.tool_fresh) return;
  if (old <= walk.scene.tracker.lost_age) {
    walk.why |= kToolPredicted;
  } else if (state.mode == Mode::away) {
    walk.tool_known = false;  // nobody is near: a tool out of sight is simply away
    walk.why |= kToolUnseen;
  } else {
    walk.why |= kToolLost;
  }
}

void take_in(const Walk& walk, CommonState& state, bool pressing) {
  const TrackerRig& rig = walk.scene.tracker;
  if (rig.prediction == Prediction::hold) return;
  const TrackedTool& pose = state.tool.value;
  const Point<'T'>& tip = walk.scene.tools[static_cast<std::size_t>(pose.tool)].tip.centre;
  observe(rig, pose.tool, exposed(rig, state.tool.t), walk.scene.X_WC * (pose.X_CT * tip),
          noise_of(rig, pose, walk.scene.X_WC), state.tip_motion, pressing);
}

// The way from `from` to `to` ends where the tool's tip meets the haptic-tip: a prediction knows nothing of a
// touch before the poses show it, and would see the tool go on right through the machine.
Point<'W'> stopped_by_tip(const Walk& walk, double tool_radius, const Point<'W'>& from,
                          const Point<'W'>& to) {
  if (!walk.stops_tool || !walk.X_WH.valid()) return to;
  const double apart = tool_radius + walk.scene.tip_radius;
  const Vec3 c = (from - walk.X_WH.origin()).e();
  const Vec3 way = (to - from).e();
  const double toward = -c.dot(way);
  if (toward <= 0.0) return to;
  const double outside = c.squaredNorm() - apart * apart;
  if (outside <= 0.0) return Point<'W'>(Vec3(from.e() + way + (toward / c.squaredNorm()) * c));  // slides
  const double root = toward * toward - way.squaredNorm() * outside;
  if (root <= 0.0) return to;  // passes by
  const double share = (toward - std::sqrt(root)) / way.squaredNorm();
  return share < 1.0 ? Point<'W'>(Vec3(from.e() + share * way)) : to;
}

// The tip goes on from the newest pose; the tool moves with it and keeps that pose's rotation: nothing is
// felt of it, and where it turns the tip, that is in the tip's own motion.
void carry_on(Walk& walk, const CommonState& state) {
  const TipMotion& motion = state.tip_motion;
  const double radius = walk.scene.tools[static_cast<std::size_t>(motion.tool)].tip.radius;
  const Point<'W'> ahead = predict(walk.scene.tracker, motion, walk.tick.t);
  const Point<'W'> tip = stopped_by_tip(walk, radius, motion.position, ahead);
  walk.X_WT = {walk.X_WT.q(), walk.X_WT.origin() + (tip - walk.tool_tip)};
  walk.tool_tip = tip;
}

}  // namespace

void track_tool(Walk& walk, CommonState& state, bool pressing) noexcept {
  if (!walk.scene.has_tracker) return;
  const auto& sample = walk.in.tool;
  if (sample.health == Health::fault) walk.why |= kTrackerFault;
  if (sample.health == Health::ok && sample.value.tool != -1) {  // -1: no tool recognised, which is no fault
    if (!plausible(walk, sample)) {
      walk.why |= kToolInvalid;
    } else if (state.tool.health == Health::absent || sample.t > state.tool.t) {
      state.tool = sample;  // older or repeated packets change nothing
      take_in(walk, state, pressing);
    }
  }
  if (state.tool.health != Health::ok) {
    walk.why |= kToolUnseen;
    return;
  }
  // A clamped tool is seen, recorded and drawn, but it presses nothing: it goes where the tip goes.
  walk.tool_known = state.tool.value.tool != walk.scene.clamped_tool;
  const Tool& tool = walk.scene.tools[static_cast<std::size_t>(state.tool.value.tool)];
  walk.X_WT = walk.scene.X_WC * state.tool.value.X_CT;
  walk.tool_tip = walk.X_WT * tool.tip.centre;
  walk.X_WT_newest = walk.X_WT;
  walk.tip_newest = walk.tool_tip;
  if (walk.scene.tracker.prediction != Prediction::hold) carry_on(walk, state);
  walk.tool_radius = tool.tip.radius;
  judge_age(walk, state);
}

}  // namespace enc::stages
