#include "core/control/task/meet/tame.h"

#include <algorithm>
#include <cmath>

#include "core/control/task/meet/finger.h"
#include "core/control/task/meet/meet_spec.h"

namespace enc::stages {
namespace {

// J, in the law's spring: by far more than that of a prop on its way that nobody presses. Chosen.
constexpr double kPressed = 2e-3;

// m and N: what the law's spring along the normal is, at this tick.
struct Spring {
  double depth, push;
};
Spring spring_of(const Walk& walk, const Impedance& law, const CommonState& state, const Meeting& now,
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
double moved(const Walk& walk, const CommonState& state, const Meeting& memory) {
  const Tamed& now = memory.tamed;
  const double dt = walk.scene.dt;
  const bool on = now.energy.on;
  const Vec3 way = on ? Vec3((walk.X_WH.origin() - now.tip).e()) : Vec3(dt * walk.tip_velocity.e());
  const Vec3 normal = on ? Vec3(0.5 * (walk.normal.e() + now.normal.e())) : Vec3(walk.normal.e());
  Vec3 other = on ? Vec3((memory.aim.target - now.target).e()) : Vec3(dt * memory.aim.velocity.e());
  if (const Moved* ball = hit_now(walk, state)) other = dt * ball->velocity.e();
  return normal.dot(way - other);
}

// A contact that is lost while the tip is inside, and found again, goes on with what was left: nothing is
// given for that a law begins anew. Where the tip has been outside nobody is owed anything.
void lose(const Walk& walk, const Meeting& memory, Tamed& now) {
  if (now.energy.on) now.kept = now.energy.left;
  now.energy = Passivity{};
  const bool known = !holding(walk) && walk.normal.finite() && memory.aim.target.finite();
  if (known && dot(memory.aim.target - walk.X_WH.origin(), walk.normal) <= 0.0) {
    now.kept = 0.0;
    now.pressed = false;
  }
}

// What the law does not send it does not give out, either. Nor is anything rendered by a prop that is still
// on its way to where it is met; one that leaps under the finger that presses it has been.
const Object* tamed_object(const Walk& walk, const CommonState& state, const Meeting& memory) {
  if (state.mode != Mode::contact || walk.in.withheld || holding(walk)) return nullptr;
  const bool met = memory.tamed.pressed && memory.tamed.object == state.object;
  if (!memory.aim.caught_up && !met) return nullptr;
  const Object* object = nearest_object(walk, state);
  const bool renders = object != nullptr && object->interaction.kind != Interaction::passive;
  const bool known = walk.along_mass > 0.0 && walk.wanted_force.finite() && walk.normal.finite();
  return renders && known ? object : nullptr;
}

}  // namespace

Tame::Tame(Walk& walk, const Impedance& law, const CommonState& state, Meeting& memory) noexcept
    : wanted(walk.wanted_force.e()) {
  if (law.rig.passivity == PassivityForm::none) return;
  Tamed& now = memory.tamed;
  const Object* object = tamed_object(walk, state, memory);
  if (object == nullptr) {
    lose(walk, memory, now);
    return;
  }
  if (now.energy.on && now.object != state.object) lose(walk, memory, now);
  const Spring spring = spring_of(walk, law, state, memory, *object);
  const Yielded tick{moved(walk, state, memory), spring.depth, spring.push};
  if (!now.energy.on) {
    begin(now.energy, tick, now.kept);
    now.kept = 0.0;
  } else {
    if (dot(walk.normal, now.normal) < MeetSpec::kTurned) renew(now.energy, tick);
    observe(now.energy, tick, law.count);
  }
  now.pressed = (now.pressed && now.object == state.object) || now.energy.stored > kPressed;
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
  const double push = pushed.dot(walk.normal.e());
  hold(memory.tamed.energy, push, push + taken);
}

}  // namespace enc::stages
