#include "core/control/world/moving.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/base/error.h"
#include "core/spec/scene_spec.h"

namespace enc {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// Share of pi sqrt(m / k), half a period of the tile's bounce, over which its firmness is smoothed (assumed:
// restitution stays exact).
constexpr double kSmooth = 0.02;
// Share of e that a ball parts with (assumed: reduced by the uncertainty of the prop's speed, so that it
// gains no energy).
constexpr double kShort = 0.95;
// m/s: a slower ball would take seconds to return, and returns at once (assumed).
constexpr double kSlow = 0.020;

// The firmness of a tile on the way back, smoothed. Encoder counts limit the rate to some 15 mm/s, which is
// all of the push at the start of a touch. The smoothing is short against the bounce, so the restitution
// stays exact.
double tile_firmness(const Mover& mover, const FingerPress& press, double dt, const MoverState& now) {
  const double time = kSmooth * std::numbers::pi * std::sqrt(mover.mass / mover.stiffness);
  const double wanted =
      press.sinks < 0.0 ? std::max(0.0, 1.0 + mover.bounce * press.sinks / now.deepest) : 1.0;
  return now.firmness + (wanted - now.firmness) * dt / (dt + time);
}

// The firmness of a ball. `deepest`: depth of the finger when q was last lowered.
double ball_firmness(const Mover& mover, const FingerPress& press, MoverState& now) {
  const double faster = -press.normal.e().dot(now.velocity.e()) - press.speed;
  if (faster <= 0.0 || press.depth >= now.deepest) return now.firmness;
  const double parting = kShort * mover.restitution * press.speed;
  const double wanted = mover.mass * (parting * parting - faster * faster);
  const double there = mover.stiffness * now.firmness * press.depth * press.depth;
  const double share = std::clamp(wanted / there, 1e-3, 1.0);
  return now.firmness * std::pow(press.depth / now.deepest, 2.0 / share - 2.0);
}

// Applies the law to the finger in this object and updates its state for the next tick. Returns the force, N.
double pressed(const Mover& mover, const FingerPress& press, double dt, MoverState& now) {
  now.depth = press.depth;
  if (!(press.depth > 0.0)) {
    now.deepest = 0.0;
    now.firmness = 1.0;
    return 0.0;
  }
  if (mover.kind == Interaction::hit) {
    now.firmness = ball_firmness(mover, press, now);
    const bool back = now.firmness < 1.0;
    now.deepest = back ? std::min(now.deepest, press.depth) : std::max(now.deepest, press.depth);
  } else {
    now.deepest = std::max(now.deepest, press.depth);
    now.firmness = tile_firmness(mover, press, dt, now);
  }
  return mover.stiffness * now.firmness * press.depth;
}

void fly(const Mover& mover, const Vec3& force, const FingerPress& press, double dt, MoverState& now) {
  const Vec3 velocity = now.velocity.e() + force * (dt / mover.mass);
  const Vec3 shift = now.shift.e() + velocity * dt;
  const bool gone = shift.norm() >= mover.travel * (1.0 - 1e-9);
  const bool slow = velocity.norm() < kSlow;
  now.velocity = gone ? Vec<'W'>::zero() : Vec<'W'>(velocity);
  now.shift = gone ? Vec<'W'>(Vec3(shift * (mover.travel / shift.norm()))) : Vec<'W'>(shift);
  const bool apart = now.deepest == 0.0 && !press.late;
  const bool clear =
      !press.finger.finite() || (press.finger - mover.centre).norm() - mover.radius - press.radius > kClear;
  if ((gone || slow) && apart && clear) now = MoverState{};
}

// Distance along `way` (in the box's own axes) until it meets the second box; infinite if it passes by.
double room(const Vec3& apart, const Vec3& sum, const Vec3& way) {
  constexpr double kBeside = 1e-9;  // m: boxes side by side do not meet
  double enter = -kNever, leave = kNever;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (std::abs(way(k)) < 1e-9) {
      if (std::abs(apart(k)) >= sum(k) - kBeside) return kNever;
      continue;
    }
    const double one = (apart(k) - sum(k)) / way(k), other = (apart(k) + sum(k)) / way(k);
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter < leave && leave > kBeside ? std::max(0.0, enter) : kNever;
}

// Least free distance of a tile that moves towards +way or -way.
double free_way(const Mover& mover, const MoverState& now, std::span<const MoverState> moved,
                double direction) {
  double least = kNever;
  const Vec3 way = mover.to_tile * mover.way.e() * direction;
  for (const Neighbour& other : mover.neighbours) {
    const Vec3 theirs =
        other.mover < 0 ? Vec3::Zero() : Vec3(moved[static_cast<std::size_t>(other.mover)].shift.e());
    const Vec3 apart = other.apart + mover.to_tile * (theirs - now.shift.e());
    least = std::min(least, room(apart, other.sum, way));
  }
  return least;
}

void slide(const Mover& mover, const Vec3& force, std::span<const MoverState> moved, double dt,
           MoverState& now) {
  const Vec3 way = mover.way.e();
  double speed = way.dot(now.velocity.e()) + way.dot(force) * dt / mover.mass;
  const double stopped = mover.friction * dt / mover.mass;  // m/s that friction removes in a tick
  speed = std::abs(speed) <= stopped ? 0.0 : speed - std::copysign(stopped, speed);
  const double before = way.dot(now.shift.e());
  if (speed == 0.0) {
    now.velocity = Vec<'W'>::zero();
    return;
  }
  const double direction = std::copysign(1.0, speed);
  const double most =
      std::min(free_way(mover, now, moved, direction), direction > 0.0 ? mover.travel - before : before);
  const double move = std::min(std::abs(speed) * dt, std::max(0.0, most));
  if (move < std::abs(speed) * dt) speed = 0.0;
  now.velocity = Vec<'W'>(Vec3(speed * way));
  now.shift = Vec<'W'>(Vec3((before + direction * move) * way));
}

}  // namespace

void move(std::span<const Mover> movers, const FingerPress& press, double dt,
          std::span<MoverState> moved) noexcept {
  for (std::size_t i = 0; i < movers.size(); ++i) {
    const Mover& mover = movers[i];
    MoverState& now = moved[i];
    Vec3 force = Vec3::Zero();
    if (mover.object == press.object && std::isfinite(press.depth)) {
      force = -pressed(mover, press, dt, now) * press.normal.e();
    } else {
      now.depth = kUnset;
      now.deepest = 0.0;
      now.firmness = 1.0;
    }
    if (mover.kind == Interaction::hit) fly(mover, force, press, dt, now);
    if (mover.kind == Interaction::shift) slide(mover, force, moved, dt, now);
    if (mover.kind == Interaction::spin) {
      now.firmness = 1.0;  // it is no free mass: only its spring is rendered
      now.velocity = mover.speed * mover.way;
      now.shift = now.shift + dt * now.velocity;
    }
  }
}

// On the way back from d1, where the spring holds all energy, m dv/dt = -k d (1 - c |v| / v1) with v1 = d1
// sqrt(k/m). Separate v and d and integrate from v = 0 there to e v1 at d = 0: -ln(1 - c e) - c e = c^2 / 2,
// 0 < c < 1/e.
double bounce_of(double restitution) {
  const double e = restitution;
  if (e > 0.999) return 1.5 * (1.0 - e * e) / (e * e * e);  // the first terms of the series
  // Left minus right is negative up to the root, -(1 - e^2) c^2 / 2 near 0, and positive beyond.
  double low = 0.0, high = 1.0 / e;
  for (int i = 0; i < 60; ++i) {
    const double c = 0.5 * (low + high);
    (-std::log1p(-c * e) - c * e > 0.5 * c * c ? high : low) = c;
  }
  return 0.5 * (low + high);
}

namespace {

struct Box {
  Point<'O'> centre;
  Vec3 half;  // m, along the axes of O
};
// Bounding box of the object; a half space has none.
std::optional<Box> box_of(const Object& object) {
  if (const auto* button = std::get_if<Button>(&object.surface.shape()))
    return Box{Point<'O'>(0, 0, -0.5 * button->thickness),
               0.5 * Vec3(button->width, button->height, button->thickness)};
  const Ball ball = object.surface.bound();
  if (!std::isfinite(ball.radius)) return {};
  return Box{ball.centre, Vec3::Constant(ball.radius)};
}

// The boxes are those of O, in the tile's axes: exact if both are parallel, else larger than necessary.
std::optional<Neighbour> neighbour_of(const Object& tile, const Object& other) {
  const auto own = box_of(tile), theirs = box_of(other);
  if (!own || !theirs) return {};
  const Mat3 turn = (tile.X_WO.q().conjugate() * other.X_WO.q()).toRotationMatrix().cwiseAbs();
  const Vec3 apart = tile.X_WO.q().conjugate() * (other.X_WO * theirs->centre - tile.X_WO * own->centre).e();
  const Neighbour found{other.moving, apart, own->half + turn * theirs->half};
  const bool overlap = ((found.sum - apart.cwiseAbs()).array() > 1e-9).all();
  return overlap ? std::nullopt : std::optional(found);  // overlapping objects are no neighbours
}

void refuse(bool wrong, const ObjectSpec& spec, const std::string& what) {
  if (wrong) throw Error("object '" + spec.name + "' " + what, "object." + spec.name + ".behaviour");
}

Mover make_mover(const ObjectSpec& spec, const Object& object) {
  const InteractionSpec& does = object.interaction;
  refuse(!(object.stiffness > 0.0), spec, "moves and has no stiffness");
  refuse(!(does.way.norm() > 1e-6), spec, "moves along a way of no length");
  if (does.kind != Interaction::spin) {
    refuse(!(does.mass > 0.0), spec, "moves and has no mass");
    refuse(!(does.restitution >= 0.05 && does.restitution <= 1.0), spec,
           "has a restitution that is not 0.05 to 1");
    refuse(!(does.friction >= 0.0), spec, "has a friction below 0");
    refuse(!(does.travel > 0.0), spec, "moves and has no travel");
  }
  refuse(does.kind == Interaction::hit && !std::isfinite(object.radius), spec,
         "has no end, and cannot be hit; expected a sphere, a button or a mesh; change its shape or its "
         "behaviour");
  Mover mover;
  mover.kind = does.kind;
  mover.stiffness = object.stiffness;
  if (does.kind != Interaction::spin)
    mover.bounce = bounce_of(does.restitution) * std::sqrt(does.mass / object.stiffness);
  mover.restitution = does.restitution;
  mover.mass = does.mass;
  mover.friction = does.friction;
  mover.way = object.X_WO * Vec<'O'>(Vec3(does.way.normalized()));
  mover.travel = does.travel;
  mover.speed = does.speed;
  mover.centre = object.centre;
  mover.radius = object.radius;
  mover.to_tile = object.X_WO.q().conjugate();
  return mover;
}

bool moves(const Object& object) {
  const Interaction kind = object.interaction.kind;
  return kind == Interaction::hit || kind == Interaction::shift || kind == Interaction::spin;
}

}  // namespace

std::vector<Mover> make_movers(const std::vector<ObjectSpec>& specs, std::vector<Object>& objects) {
  std::vector<Mover> movers;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!moves(objects[i])) continue;
    refuse(movers.size() == kMostMoving, specs[i], "is one too many: at most 16 objects of a scene move");
    objects[i].moving = static_cast<std::int32_t>(movers.size());
    movers.push_back(make_mover(specs[i], objects[i]));
    movers.back().object = static_cast<std::int32_t>(i);
  }
  for (Mover& mover : movers) {
    if (mover.kind != Interaction::shift) continue;
    const auto own = static_cast<std::size_t>(mover.object);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const auto neighbour = i == own ? std::nullopt : neighbour_of(objects[own], objects[i]);
      // Objects that the tile never reaches are not checked each tick.
      if (neighbour && (neighbour->mover >= 0 ||
                        room(neighbour->apart, neighbour->sum, mover.to_tile * mover.way.e()) < mover.travel))
        mover.neighbours.push_back(*neighbour);
    }
  }
  return movers;
}

}  // namespace enc
