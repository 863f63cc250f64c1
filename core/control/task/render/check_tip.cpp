// Is the tip where it may be: inside the object [VHMR 3.3], and inside the surface that the user sees
// [VHMR 3.5]?
#include <cmath>
#include <numbers>

#include "core/control/safety/inside.h"
#include "core/control/stages/guard.h"
#include "core/control/task/render/render.h"
#include "core/shape/deformation/dent.h"

namespace enc::stages {
namespace {

// m: play and overshoot of a machine take no more before it is a fault (assumed: no source).
constexpr double kPlay = 50e-6;
// m: no tip and no dent of a display is larger, and no object farther (assumed: well beyond a machine's
// reach).
constexpr double kWidestTip = 0.1, kLongestTip = 1.0, kDeepestDent = 0.1, kFarthestTip = 10.0;
// The axis of a tip is a unit vector to this (assumed: no source).
constexpr double kUnit = 1e-3;
// Share of the margin within which what was outside the seen surface is inside again (assumed: no source).
constexpr double kWellInside = 0.7;

bool command_stays(const Walk& walk, CommonState& state, const Commanded& now) {
  Inside inside(walk.scene, state.object, least_depth(walk), Vec<'W'>::zero(), state.hints.command);
  const Brake brake = brake_of(walk, now);
  const double here = inside.depth(brake.at);
  return here >= walk.scene.tip_radius && inside.can_stop(brake, here, brake.velocity);
}

// `distance`: of the tip's outermost point to the undeformed surface, m.
void check_undeformed(Walk& walk, double distance, CommonState& state, const Commanded& now) {
  // On the way in the tip is rightly outside, and so is what it is told.
  if (!state.entered && distance <= -kSkin) state.entered = command_stays(walk, state, now);
  if (state.entered && distance > kPlay) walk.why |= kOutsideObject;
}

bool possible(const Tip<'O'>& tip) {
  return tip.centre.finite() && tip.centre.e().norm() < kFarthestTip && tip.radius >= 0.0 &&
         tip.radius < kWidestTip && tip.shape <= TipShape::edge && std::abs(tip.axis.norm() - 1.0) < kUnit &&
         tip.half_angle >= 0.0 && tip.half_angle < 0.5 * std::numbers::pi && tip.length >= 0.0 &&
         tip.length < kLongestTip;
}

bool possible(const Walk& walk, const Stamped<DentSample>& sample) {
  const DentSample& dent = sample.value;
  if (sample.t > walk.tick.t + walk.tick.dt) return false;
  if (dent.object == -1) return true;
  return dent.object >= 0 && dent.object < static_cast<int>(walk.scene.objects.size()) &&
         possible(dent.tip) && dent.depth >= 0.0 && dent.depth < kDeepestDent;
}

// The seen surface is late: the tip may be outside it by what tool and tip can have moved since [VHMR 3.5].
void check_dent(Walk& walk, const Object& object, const Point<'O'>& outer, double distance,
                CommonState& state, Rendering& now) {
  if (walk.in.dent.health == Health::fault ||
      (walk.in.dent.health == Health::ok && !possible(walk, walk.in.dent))) {
    walk.why |= kDentWrong;
    return;
  }
  if (walk.in.dent.health == Health::ok && (now.dent.health == Health::absent || walk.in.dent.t > now.dent.t))
    now.dent = walk.in.dent;
  const DisplayRig& rig = walk.scene.display;
  // Before the first surface the time runs from the start of the experiment.
  const double old = age(walk.tick.t, now.dent.t);
  if (old > rig.overdue) {
    if (state.mode != Mode::away) walk.why |= kDentOverdue;
    return;
  }
  if (now.dent.value.object != state.object) {
    now.outside_dent = false;
    return;
  }
  // A fused tip is drawn ahead by the lead: tool and tip may stop or turn in that time, too.
  const double unsure = old + (rig.tip == SeenTip::fused ? rig.lead : 0.0);
  // The margin shrinks with each new frame: what was outside counts as inside again only well within it.
  const double margin = (rig.margin + rig.margin_speed * unsure) * (now.outside_dent ? kWellInside : 1.0);
  // On the way in, the tip is rightly outside. A dent moves the surface by its depth at most: mostly that is
  // answer enough.
  const bool maybe = state.entered && distance + now.dent.value.depth > margin;
  now.outside_dent =
      maybe && dented_distance(object.surface, now.dent.value, outer, walk.at_tip.feature) > margin;
  if (now.outside_dent) walk.why |= kOutsideDent;
}

}  // namespace

void check_tip(Walk& walk, CommonState& state, Rendering& now) noexcept {
  if (!walk.X_WH.valid() || state.object < 0) return;
  const Object& object = walk.scene.objects[static_cast<std::size_t>(state.object)];
  const Point<'O'> centre = object.X_OW * walk.X_WH.origin();
  ObjectHint& hint = state.hints.tip;
  walk.at_tip = object.surface.nearest(centre, hint.object == state.object ? hint.feature : -1);
  hint = {state.object, walk.at_tip.feature};
  // The point of the tip that is nearest to the outside of the object.
  const Point<'O'> outer = centre + walk.scene.tip_radius * walk.at_tip.normal;
  const double distance = object.surface.nearest(outer, walk.at_tip.feature).distance;
  check_undeformed(walk, distance, state, now);
  if (walk.scene.has_display) check_dent(walk, object, outer, distance, state, now);
}

}  // namespace enc::stages
