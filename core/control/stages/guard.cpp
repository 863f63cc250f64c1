#include "core/control/stages/guard.h"

#include <algorithm>
#include <cmath>

#include "core/control/safety/inside.h"

namespace enc::stages {
namespace {

// The part of the path to the target that the machine can reach.
Point<'R'> reachable(ManipulatorContext& context, const Point<'R'>& from, const Point<'R'>& to) {
  const Quat q = context.scene.X_WR.q().conjugate();
  const auto ok = [&](const Point<'R'>& p) { return context.scene.reach.contains(Pose<'R', 'H'>(q, p)); };
  if (ok(to) || !ok(from)) return to;
  context.why |= kUnreachable;
  double lo = 0.0;
  double hi = 1.0;
  for (int i = 0; i < 20; ++i) {
    const double mid = 0.5 * (lo + hi);
    (ok(from + mid * (to - from)) ? lo : hi) = mid;
  }
  return from + lo * (to - from);
}

// Keeps speed and acceleration within the machine's limits. The normal comes first and is one-dimensional, so
// the command can never overshoot the surface or the deflection limit, whatever the target does. The sideways
// motion gets the rest.
Vec3 next_velocity(ManipulatorContext& context, const Walls& walls, const Vec3& way, const Vec3& before) {
  const double dt = context.scene.dt;
  const Reach& reach = context.scene.reach;
  const double most = reach.acceleration * dt;
  const auto toward = [&](double distance) {
    return std::min(
        {approach_speed(distance, walls.share * reach.acceleration, dt), reach.speed, walls.speed});
  };
  const double along = walls.normal.dot(way);
  const double v0 = walls.normal.dot(before);
  const Vec3 side_before = before - v0 * walls.normal;
  double wanted = std::copysign(toward(std::abs(along)), along);
  // Beyond the surface, move back in.
  const double outward = walls.out >= 0.0 ? toward(walls.out) : -toward(-walls.out);
  wanted = std::clamp(wanted, std::min(outward, -toward(std::max(0.0, walls.in))), outward);
  // Not faster than the sideways motion can make room for in this tick.
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
  if (change.norm() > rest * (1.0 + 1e-9) || std::abs(wanted - v) > 1e-9) context.why |= kLimited;
  if (change.norm() > rest) change *= rest / change.norm();
  Vec3 side = side_before + change;
  if (side.norm() > fastest) {
    const Vec3 kept = side * (fastest / side.norm());
    side = (kept - side_before).norm() <= rest * (1.0 + 1e-9) ? kept : slowed(side_before, rest);
  }
  return side + v * walls.normal;
}

// The walls describe the nearest side only; beside an edge there are others.
Vec3 kept_inside(ManipulatorContext& context, CommonState& state, const CommandState& now, const Walls& walls,
                 const Vec3& wanted) {
  if (std::isnan(walls.depth)) return wanted;
  // Usually there is room for the whole stopping distance.
  const double speed = wanted.norm();
  const double way = speed * (context.scene.dt + speed / (2.0 * context.scene.reach.acceleration));
  if (walls.depth - way >= least_depth(context)) return wanted;
  Inside inside(context.scene, state.object, least_depth(context), Vec<'W'>::zero(), state.hints.command);
  const Vec3 kept = inside.velocity(brake_of(context, now), walls.depth, wanted);
  if (kept != wanted) context.why |= kLimited;
  return kept;
}

// Velocity of the next set-point, in W.
Vec3 commanded(ManipulatorContext& context, CommonState& state, const CommandState& now, const Walls& walls,
               const Vec3& before) {
  const double dt = context.scene.dt;
  const double acceleration = context.scene.reach.acceleration;
  const Vec3 straight = slowed(before, acceleration * dt);
  if ((context.why & kNotFollowing) != 0 && context.X_WH.valid())
    // Move back to the machine's position. Otherwise the machine would jump to the command as soon as it can
    // move.
    return kept_inside(
        context, state, now, walls,
        next_velocity(context, walls, context.X_WH.p() - (context.scene.X_WR * now.command).e(), before));
  if (holding(context)) {
    // Brake straight to standstill, unless that would carry the tip out of the object. A tip that is outside
    // is brought back in.
    const bool safe = walls.out >= 0.0 &&
                      walls.normal.dot(straight) <= approach_speed(walls.out, kAlongShare * acceleration, dt);
    return safe
               ? straight
               : kept_inside(context, state, now, walls, next_velocity(context, walls, Vec3::Zero(), before));
  }
  Point<'R'> target = context.scene.X_WR.inverse() * context.target;
  if (!target.finite()) {
    context.why |= kNotFinite;
    return straight;
  }
  target = reachable(context, now.command, target);
  return kept_inside(
      context, state, now, walls,
      next_velocity(context, walls, context.scene.X_WR.q() * (target - now.command).e(), before));
}

// Vector from base to platform, in R.
Vec3 strut_of(const Hexapod& machine, const Point<'R'>& at, const Mat3& R, int leg) {
  return at.e() + R * machine.platform_joint(leg) - machine.base_joint(leg);
}

// Legs have a shortest length, so the reach is not convex: a path of 3 mm between two points within it can
// leave it by 8 um. Each leg is shortest where the path is at right angles to it.
bool legs_reach_along(const Hexapod& machine, const Pose<'R', 'H'>& from, const Vec3& way) {
  const double shortest = machine.zero_length() - machine.geometry().stroke;
  const Mat3 R = from.q().toRotationMatrix();
  for (int leg = 0; leg < 6; ++leg) {
    const Vec3 strut = strut_of(machine, from.origin(), R, leg);
    const double share = -strut.dot(way) / way.squaredNorm();
    if (share > 0.0 && share < 1.0 && (strut + share * way).norm() < shortest) return false;
  }
  return true;
}

// m: a leg this close to its end is at the edge of the reach (derived: more than a tick's way there, where
// the machine is slow).
constexpr double kAtEnd = 0.1e-3;

// Velocity along the edge of the reach, without the part that shortens the shortest leg or lengthens the
// longest one. The path to a reachable target may start outwards, because the reach is not convex and the
// normal comes first. A tip that stopped there would stay there.
Vec3 along_edge(const Hexapod& machine, const Pose<'R', 'H'>& at, Vec3 velocity, double braking_time) {
  const Mat3 R = at.q().toRotationMatrix();
  const double stroke = machine.geometry().stroke;
  for (int again = 0; again < 3; ++again) {  // a correction for one leg may not suit the next one
    for (int leg = 0; leg < 6; ++leg) {
      const Vec3 strut = strut_of(machine, at.origin(), R, leg);
      const double out = strut.norm() - machine.zero_length(), along = strut.dot(velocity);
      // Straight motion at right angles to a leg lengthens it by v^2 t / 2 over its length in the time t.
      const double longer = velocity.squaredNorm() * braking_time;
      if (out < kAtEnd - stroke && along < 0.0) velocity -= strut * (along / strut.squaredNorm());
      if (out > stroke - kAtEnd && along > -longer)
        velocity -= strut * ((along + longer) / strut.squaredNorm());
    }
  }
  return velocity;
}

}  // namespace

Brake brake_of(const ManipulatorContext& context, const CommandState& now) {
  const Pose<'W', 'R'>& X_WR = context.scene.X_WR;
  const Reach& reach = context.scene.reach;
  return {X_WR * now.command, X_WR.q() * now.command_velocity.e(), reach.acceleration, reach.speed,
          context.scene.dt};
}

void limit_command(ManipulatorContext& context, CommonState& state, CommandState& now,
                   const Walls& walls) noexcept {
  const double dt = context.scene.dt;
  const double acceleration = context.scene.reach.acceleration;
  const Quat q_WR = context.scene.X_WR.q();
  const Quat q_RH = q_WR.conjugate();
  const Vec3 before = now.command_velocity.e();
  Vec3 after = q_RH * commanded(context, state, now, walls, q_WR * before);
  // If the machine braked from the next tick on, its stopping position and the path there must be within
  // reach.
  const Reach& reach = context.scene.reach;
  const Pose<'R', 'H'> from(q_RH, now.command);
  const auto safe = [&](const Vec3& velocity) {
    const Vec3 way = braking_way(velocity, acceleration, dt);
    return reach.contains(Pose<'R', 'H'>(q_RH, now.command + Vec<'R'>(way))) &&
           legs_reach_along(reach.machine, from, way);
  };
  if (!safe(after) && reach.contains(from)) {
    context.why |= kUnreachable;
    // A held machine does not move along the edge. Inside an object, the tip stays inside on that path.
    const bool goes = !holding(context);
    const double braking_time = dt + after.norm() / (2.0 * acceleration);
    Vec3 aside = goes ? along_edge(reach.machine, from, after, braking_time) : before;
    if (goes) aside = q_RH * kept_inside(context, state, now, walls, q_WR * aside);
    const bool can = goes && (aside - before).norm() <= acceleration * dt * (1.0 + 1e-9) && safe(aside);
    after = can ? aside : slowed(before, acceleration * dt);
  }
  now.command_velocity = Vec<'R'>(after);
  now.command = Point<'R'>(Vec3(now.command.e() + dt * after));
}

}  // namespace enc::stages
