#include "core/task/meet/tame.h"

#include <algorithm>
#include <cmath>

#include "core/task/meet/finger.h"

namespace enc::stages {
namespace {

// m and N: what the law's spring along the normal is, at this tick.
struct Spring {
  double depth, push;
};
Spring spring_of(const Walk& walk, const Impedance& law, const State& state, const Meeting& now,
                 const Object& object) {
  if (const Moved* ball = hit_now(walk, state)) {
    const double depth = std::isnan(ball->depth) ? 0.0 : std::max(0.0, ball->depth);
    return {depth, object.stiffness * ball->firmness * depth};
  }
  const double depth = dot(now.aim.target - walk.X_WH.origin(), walk.normal);
  return {depth, now.aim.gain * law.rig.stiffness * (depth - now.aim.sunk)};
}

// m: how far the tip has gone outwards, against its target; that of a ball goes with the tip, so against the
// ball.
double moved(const Walk& walk, const State& state, const Meeting& memory) {
  const Tamed& now = memory.tamed;
  const double dt = walk.scene.dt;
  const bool on = now.energy.on;
  const Vec3 way = on ? Vec3((walk.X_WH.origin() - now.tip).e()) : Vec3(dt * walk.tip_velocity.e());
  const Vec3 normal = on ? Vec3(0.5 * (walk.normal.e() + now.normal.e())) : Vec3(walk.normal.e());
  Vec3 other = on ? Vec3((memory.aim.target - now.target).e()) : Vec3(dt * memory.aim.velocity.e());
  if (const Moved* ball = hit_now(walk, state)) other = dt * ball->velocity.e();
  return normal.dot(way - other);
}

}  // namespace

Tame::Tame(Walk& walk, const Impedance& law, const State& state, Meeting& memory) noexcept
    : wanted(walk.wanted_force.e()) {
  if (law.rig.passivity == PassivityForm::none) return;
  Tamed& now = memory.tamed;
  const Object* object = state.mode == Mode::contact ? nearest_object(walk, state) : nullptr;
  const bool renders = object != nullptr && object->interaction.kind != Interaction::passive;
  if (!renders || !(walk.along_mass > 0.0) || !wanted.allFinite() || !walk.normal.finite()) {
    now = Tamed{};
    return;
  }
  if (now.object != state.object) now = Tamed{};
  const Spring spring = spring_of(walk, law, state, memory, *object);
  const Yielded tick{moved(walk, state, memory), spring.depth, spring.push};
  constexpr double kTurned = 0.9;  // cosine: it is another side of the object
  if (!now.energy.on) {
    begin(now.energy, tick, std::max(0.0, 0.5 * spring.push * spring.depth));
  } else {
    if (dot(walk.normal, now.normal) < kTurned) renew(now.energy, tick);
    observe(now.energy, tick, law.count);
  }
  now.object = state.object;
  now.tip = walk.X_WH.origin();
  now.target = memory.aim.target;
  now.normal = walk.normal;
  const double dt = walk.scene.dt, asked = wanted.dot(walk.normal.e());
  const double given = passive(now.energy, asked, dt * dt / (2.0 * walk.along_mass), law.count);
  if (given == asked) return;
  walk.why |= kPassive;
  wanted += (given - asked) * walk.normal.e();
  taken = std::clamp(asked, -law.rig.peak, law.rig.peak) - std::clamp(given, -law.rig.peak, law.rig.peak);
}

void Tame::held(const Walk& walk, Meeting& memory, const Vec3& pushed) const noexcept {
  if (!memory.tamed.energy.on) return;
  const double push = walk.in.withheld ? 0.0 : pushed.dot(walk.normal.e());
  hold(memory.tamed.energy, push, push + (walk.in.withheld ? 0.0 : taken));
}

}  // namespace enc::stages
