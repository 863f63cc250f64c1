// The last word before the machine: is the tip where it may be, and can the machine do what it is asked?
// Otherwise hold.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/dent/dent.h"
#include "core/safety/braking.h"
#include "core/safety/inside.h"
#include "core/task/walk.h"

namespace enc::stages {
namespace {

// Of the tip's centre: where all of the tip is inside.
double least_depth(const Walk& walk) { return walk.scene.tip_radius + kSkin; }

Brake brake_of(const Walk& walk, const State& state) {
  const Pose<'W', 'R'>& X_WR = walk.scene.X_WR;
  const Reach& reach = walk.scene.reach;
  return {X_WR * state.command, X_WR.q() * state.command_velocity.e(), reach.acceleration, reach.speed,
          walk.scene.dt};
}

bool command_stays(const Walk& walk, State& state) {
  Inside inside(walk.scene, state.object, least_depth(walk), Vec<'W'>::zero(), state.hints.command);
  const Brake brake = brake_of(walk, state);
  const double here = inside.depth(brake.at);
  return here >= walk.scene.tip_radius && inside.can_stop(brake, here, brake.velocity);
}

// `distance`: of the tip's outermost point to the undeformed surface, m.
void check_undeformed(Walk& walk, double distance, State& state) {
  constexpr double kTolerance =
      50e-6;  // m: what play and overshoot of a machine may take before it is a fault
  // On the way in the tip is rightly outside, and so is what it is told.
  if (!state.entered && distance <= -kSkin) state.entered = command_stays(walk, state);
  if (state.entered && distance > kTolerance) walk.why |= kOutsideObject;
}

bool possible(const Tip<'O'>& tip) {
  return tip.centre.finite() && tip.centre.e().norm() < 10.0 && tip.radius >= 0.0 && tip.radius < 0.1 &&
         tip.shape <= TipShape::edge && std::abs(tip.axis.norm() - 1.0) < 1e-3 && tip.half_angle >= 0.0 &&
         tip.half_angle < 0.5 * std::numbers::pi && tip.length >= 0.0 && tip.length < 1.0;
}

bool possible(const Walk& walk, const Stamped<DentSample>& sample) {
  const DentSample& dent = sample.value;
  if (sample.t > walk.tick.t + walk.tick.dt) return false;
  if (dent.object == -1) return true;
  return dent.object >= 0 && dent.object < static_cast<int>(walk.scene.objects.size()) &&
         possible(dent.tip) && dent.depth >= 0.0 && dent.depth < 0.1;
}

// The seen surface is late: the tip may be outside it by what tool and tip can have moved since [VHMR 3.5].
void check_dent(Walk& walk, const Object& object, const Point<'O'>& outer, double distance, State& state) {
  if (walk.in.dent.health == Health::fault ||
      (walk.in.dent.health == Health::ok && !possible(walk, walk.in.dent))) {
    walk.why |= kDentWrong;
    return;
  }
  if (walk.in.dent.health == Health::ok &&
      (state.dent.health == Health::absent || walk.in.dent.t > state.dent.t))
    state.dent = walk.in.dent;
  const DisplayRig& rig = walk.scene.display;
  // Before the first surface the time runs from the start of the experiment.
  const double old = age(walk.tick.t, state.dent.t);
  if (old > rig.overdue) {
    if (state.mode != Mode::away) walk.why |= kDentOverdue;
    return;
  }
  if (state.dent.value.object != state.object) {
    state.outside_dent = false;
    return;
  }
  // The margin shrinks with each new frame: what was outside counts as inside again only well within it.
  const double margin = (rig.margin + rig.margin_speed * old) * (state.outside_dent ? 0.7 : 1.0);
  // On the way in, the tip is rightly outside. A dent moves the surface by its depth at most: mostly that is
  // answer enough.
  const bool maybe = state.entered && distance + state.dent.value.depth > margin;
  state.outside_dent =
      maybe && dented_distance(object.surface, state.dent.value, outer, walk.at_tip.feature) > margin;
  if (state.outside_dent) walk.why |= kOutsideDent;
}

// The part of the way to the target that the machine can reach.
Point<'R'> reachable(Walk& walk, const Point<'R'>& from, const Point<'R'>& to) {
  const Quat q = walk.scene.X_WR.q().conjugate();
  const auto ok = [&](const Point<'R'>& p) { return walk.scene.reach.contains(Pose<'R', 'H'>(q, p)); };
  if (ok(to) || !ok(from)) return to;
  walk.why |= kUnreachable;
  double lo = 0.0;
  double hi = 1.0;
  for (int i = 0; i < 20; ++i) {
    const double mid = 0.5 * (lo + hi);
    (ok(from + mid * (to - from)) ? lo : hi) = mid;
  }
  return from + lo * (to - from);
}

// How far the command may still go along a normal: out to the surface, in to the deflection limit.
struct Walls {
  Vec3 normal = Vec3::UnitZ();                                                                         // in W
  double out = std::numeric_limits<double>::infinity(), in = std::numeric_limits<double>::infinity();  // m
  double speed = std::numeric_limits<double>::infinity();  // along the normal, m/s
  double share = kAlongShare;                              // of the acceleration, along the normal
  double depth = kUnset;                                   // of the tip's centre in the object, m
};

Walls walls_around(const Walk& walk, State& state) {
  if (walk.scene.probe) {  // nothing but the end of the push: the object is real
    const Probe& probe = *walk.scene.probe;
    Walls walls{probe.X_WN.q() * Vec3::UnitZ()};
    walls.in = probe.depth - probe.deflection(walk.scene.X_WR * state.command);
    return walls;
  }
  // Nothing is in the way, and nothing is sideways of a straight leg: so each is a trapezoid of the leg's
  // speed and the machine's whole acceleration.
  if (walk.scene.travel) {
    const Travel& travel = *walk.scene.travel;
    if (!travel.on_leg(state.travelling.leg)) return {};
    const TravelLeg& leg = travel.legs[static_cast<std::size_t>(state.travelling.leg)];
    Walls walls{leg.along.e()};
    walls.speed = leg.speed;
    walls.share = 1.0;
    return walls;
  }
  if (state.object < 0 || !state.entered) return {};
  const Object& object = walk.scene.objects[static_cast<std::size_t>(state.object)];
  const NearestInWorld at =
      nearest(walk.scene, state.object, walk.scene.X_WR * state.command, state.hints.command);
  const double depth = -(at.distance + walk.scene.tip_radius);
  Walls walls{at.normal.e(), depth - kSkin};
  walls.depth = -at.distance;
  if (state.mode == Mode::contact) walls.in = object.limit_at(state.contacts) + kSkin - depth;
  return walls;
}

// Speed and acceleration stay within the machine's limits. The way along the normal comes first and is
// one-dimensional, so that the command can never overshoot the surface or the deflection limit, whatever the
// target does; the sideways way gets the rest.
Vec3 next_velocity(Walk& walk, const Walls& walls, const Vec3& way, const Vec3& before) {
  const double dt = walk.scene.dt;
  const Reach& reach = walk.scene.reach;
  const double most = reach.acceleration * dt;
  const auto toward = [&](double distance) {
    return std::min(
        {approach_speed(distance, walls.share * reach.acceleration, dt), reach.speed, walls.speed});
  };
  const double along = walls.normal.dot(way);
  const double v0 = walls.normal.dot(before);
  const Vec3 side_before = before - v0 * walls.normal;
  double wanted = std::copysign(toward(std::abs(along)), along);
  // Beyond the surface the way leads back in.
  const double outward = walls.out >= 0.0 ? toward(walls.out) : -toward(-walls.out);
  wanted = std::clamp(wanted, std::min(outward, -toward(std::max(0.0, walls.in))), outward);
  // Not faster than what the sideways way can make room for in this tick.
  const double side_least = std::max(0.0, side_before.norm() - kSideShare * most);
  const double room = std::sqrt(std::max(0.0, reach.speed * reach.speed - side_least * side_least));
  const double v =
      std::clamp(v0 + std::clamp(wanted - v0, -walls.share * most, walls.share * most), -room, room);

  const Vec3 aside = way - along * walls.normal;
  const double distance = aside.norm();
  const double fastest = std::sqrt(std::max(0.0, reach.speed * reach.speed - v * v));
  const double side_speed = std::min(approach_speed(distance, kSideShare * reach.acceleration, dt), fastest);
  const Vec3 side_wanted = distance > 0.0 ? Vec3(aside * (side_speed / distance)) : Vec3(Vec3::Zero());
  const double rest = std::sqrt(std::max(0.0, most * most - (v - v0) * (v - v0)));
  Vec3 change = side_wanted - side_before;
  if (change.norm() > rest * (1.0 + 1e-9) || std::abs(wanted - v) > 1e-9) walk.why |= kLimited;
  if (change.norm() > rest) change *= rest / change.norm();
  Vec3 side = side_before + change;
  if (side.norm() > fastest) side = slowed(side_before, rest);
  return side + v * walls.normal;
}

}  // namespace

namespace {

// A machine that did not follow may go on at any time: the hold lasts until the tool has gone and the command
// is back where the machine is; where nobody sees a tool, to the end.
void hold_lost(Walk& walk, State& state) {
  if (!state.following.lost) return;
  constexpr double kBack = 1e-3;                                                            // m
  const bool back = (walk.X_WH.origin() - walk.scene.X_WR * state.command).norm() < kBack;  // false for NaN
  const bool gone =
      walk.scene.has_tracker && walk.tool_known && walk.tool_fresh && walk.gap > walk.scene.follow.pause;
  if (gone && back) {
    state.following = Following{};
    state.mode = Mode::away;
  } else {
    walk.why |= kNotFollowing;
  }
}

}  // namespace

void check_tip(Walk& walk, State& state) noexcept {
  hold_lost(walk, state);
  if (walk.scene.probe) return;  // a real surface is not ours to keep inside of
  if (!walk.X_WH.valid() || state.object < 0) return;
  const Object& object = walk.scene.objects[static_cast<std::size_t>(state.object)];
  const Point<'O'> centre = object.X_OW * walk.X_WH.origin();
  ObjectHint& hint = state.hints.tip;
  walk.at_tip = object.surface.nearest(centre, hint.object == state.object ? hint.feature : -1);
  hint = {state.object, walk.at_tip.feature};
  // The point of the tip that is nearest to the outside of the object.
  const Point<'O'> outer = centre + walk.scene.tip_radius * walk.at_tip.normal;
  const double distance = object.surface.nearest(outer, walk.at_tip.feature).distance;
  check_undeformed(walk, distance, state);
  if (walk.scene.has_display) check_dent(walk, object, outer, distance, state);
}

namespace {

// The walls know the side that is nearest; beside an edge there are others.
Vec3 kept_inside(Walk& walk, State& state, const Walls& walls, const Vec3& wanted) {
  if (std::isnan(walls.depth)) return wanted;
  // Mostly there is room for the whole way that it takes to stop.
  const double speed = wanted.norm();
  const double way = speed * (walk.scene.dt + speed / (2.0 * walk.scene.reach.acceleration));
  if (walls.depth - way >= least_depth(walk)) return wanted;
  Inside inside(walk.scene, state.object, least_depth(walk), Vec<'W'>::zero(), state.hints.command);
  const Vec3 kept = inside.velocity(brake_of(walk, state), walls.depth, wanted);
  if (kept != wanted) walk.why |= kLimited;
  return kept;
}

// Velocity of the next set-point, in W.
Vec3 commanded(Walk& walk, State& state, const Vec3& before) {
  const double dt = walk.scene.dt;
  const double acceleration = walk.scene.reach.acceleration;
  const Walls walls = walls_around(walk, state);
  const Vec3 straight = slowed(before, acceleration * dt);
  if ((walk.why & kNotFollowing) != 0 && walk.X_WH.valid())
    // Back to where the machine is, or it would leap to the command as soon as it can.
    return kept_inside(
        walk, state, walls,
        next_velocity(walk, walls, walk.X_WH.p() - (walk.scene.X_WR * state.command).e(), before));
  if (holding(walk)) {
    // Straight to a standstill, unless that would carry the tip out of the object; a tip that is outside is
    // brought back in.
    const bool safe = walls.out >= 0.0 &&
                      walls.normal.dot(straight) <= approach_speed(walls.out, kAlongShare * acceleration, dt);
    return safe ? straight
                : kept_inside(walk, state, walls, next_velocity(walk, walls, Vec3::Zero(), before));
  }
  Point<'R'> target = walk.scene.X_WR.inverse() * walk.target;
  if (!target.finite()) {
    walk.why |= kNotFinite;
    return straight;
  }
  target = reachable(walk, state.command, target);
  return kept_inside(walk, state, walls,
                     next_velocity(walk, walls, walk.scene.X_WR.q() * (target - state.command).e(), before));
}

// Legs have a shortest length, so the reach is not convex: a way of 3 mm between two points within it can
// leave it by 8 um. Each leg is shortest where the way is at right angles to it.
bool legs_reach_along(const Hexapod& machine, const Pose<'R', 'H'>& from, const Vec3& way) {
  const double shortest = machine.zero_length() - machine.geometry().stroke;
  const Mat3 R = from.q().toRotationMatrix();
  for (int leg = 0; leg < 6; ++leg) {
    const Vec3 strut = from.p() + R * machine.platform_joint(leg) - machine.base_joint(leg);
    const double share = -strut.dot(way) / way.squaredNorm();
    if (share > 0.0 && share < 1.0 && (strut + share * way).norm() < shortest) return false;
  }
  return true;
}

}  // namespace

void limit_command(Walk& walk, State& state) noexcept {
  if (!state.started) return;  // nothing is known of the machine: nothing is said to it
  const double dt = walk.scene.dt;
  const double acceleration = walk.scene.reach.acceleration;
  const Quat q_WR = walk.scene.X_WR.q();
  const Quat q_RH = q_WR.conjugate();
  const Vec3 before = state.command_velocity.e();
  Vec3 after = q_RH * commanded(walk, state, q_WR * before);
  // Where the machine would come to rest if it braked from the next tick on: that must be within reach, and
  // the way there, too.
  const Vec3 way = braking_way(after, acceleration, dt);
  const Reach& reach = walk.scene.reach;
  const Pose<'R', 'H'> from(q_RH, state.command);
  const bool safe = reach.contains(Pose<'R', 'H'>(q_RH, state.command + Vec<'R'>(way))) &&
                    legs_reach_along(reach.machine, from, way);
  if (!safe && reach.contains(from)) {
    walk.why |= kUnreachable;
    after = slowed(before, acceleration * dt);
  }
  state.command_velocity = Vec<'R'>(after);
  state.command = Point<'R'>(Vec3(state.command.e() + dt * after));
}

}  // namespace enc::stages
