// Depth in, force out [VisHap eq. 2, 3, 7]; and what of that the motors give [VisHap eq. 4 to 6].
#include <algorithm>
#include <cmath>

#include "core/control/task/meet/arm_loop.h"
#include "core/control/task/meet/finger.h"
#include "core/control/task/meet/meet_spec.h"
#include "core/control/task/meet/tame.h"

namespace enc::stages {
namespace {

// While the finger is far the arm is motionless [VisHap 2]: the law does no more, and friction holds it. One
// count of an encoder is 0.03 mm and 14 mm/s: at the edge between two counts the law alone would keep
// the tip dithering. It must have stood before: the filtered rate dies out in 40 ms without a count. Where it
// only turns round, friction would not hold what then pushes it.
bool resting(const CommonState& state, const Aim& now, const Vec3& error, const Vec3& velocity) {
  return state.mode == Mode::away && error.norm() < RestSpec::kNear && velocity.norm() < RestSpec::kCounts &&
         now.velocity.norm() < RestSpec::kTargetStill && now.error_rate.norm() < RestSpec::kStood;
}

// It rests, and stays where it came to rest. Where it does not although nothing moves its target, the law
// goes on until it stands again with all of its push: a count that changes then is no reason to go on.
bool stays(const CommonState& state, const Point<'W'>& tip, bool rests, const Vec3& error, Aim& now) {
  if (state.mode != Mode::away) now.slipped = false;
  const bool left = now.stood.finite() && (!rests || (tip - now.stood).norm() > RestSpec::kSlips);
  now.slipped =
      now.slipped || (left && state.mode == Mode::away && now.velocity.norm() < RestSpec::kTargetStill);
  const bool arrived =
      now.stood.finite() || !now.slipped || (now.error.e() - error).norm() <= RestSpec::kArrived;
  const bool stands = rests && !left && arrived;
  if (!stands)
    now.stood = {};
  else if (!now.stood.finite())
    now.stood = tip;
  return stands;
}

// What is left in a tick of what pushes an arm that rests. Friction may just hold that, and the same push
// turns a joint more where the tip has crept; less of it friction holds surely. So it fades, where the weight
// is held beside it. Where the tip has slipped then, the weight is another one, and friction does not hold
// the difference: then the push stays.
double fading(const Impedance& law, const Aim& now, double dt) {
  return law.rig.gravity == GravityForm::exact && !now.slipped ? 1.0 / (1.0 + dt / RestSpec::kFades) : 1.0;
}

// Of the second derivative of e [eq. 2] only the target's own is known: the force that it takes to go along.
// It is no measurement, and needs no filter: behind that of eq. 3 it would come late and overshoot.
Vec3 going_along(const Walk& walk, const Arm& arm, const Mat3& mass) {
  if (walk.target_acceleration.isZero()) return Vec3::Zero();
  const Pose<'W', 'R'>& X_WR = walk.scene.X_WR;
  const Vec<'R'> wanted = X_WR.inverse() * Vec<'W'>(walk.target_acceleration);
  return (X_WR * arm.force_to_accelerate(walk.jacobian, mass, wanted)).e();
}

}  // namespace

void impede(Walk& walk, const Impedance& law, CommonState& state, Meeting& memory) noexcept {
  if (!walk.X_WH.valid() || holding(walk)) return;
  Aim& now = memory.aim;
  const Vec3 normal = walk.normal.finite() ? Vec3(walk.normal.e()) : Vec3(Vec3::UnitZ());
  const Vec3 error = (now.target - walk.X_WH.origin()).e() - now.sunk * normal;
  const Vec3 rate = (now.velocity - walk.tip_velocity).e();
  const bool rests =
      stays(state, walk.X_WH.origin(), resting(state, now, error, walk.tip_velocity.e()), error, now);
  const double fade = fading(law, now, walk.scene.dt);
  const Mat3 mass = law.arm.mass(walk.in.arm.value.joints, law.prop_mass);
  if (law.rig.passivity == PassivityForm::controlled && walk.normal.finite())
    walk.along_mass = law.arm.felt_mass(walk.jacobian, mass, walk.scene.X_WR.inverse() * walk.normal);
  const double a = law.filter_gain;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    now.error.xyz[i] = rests ? fade * now.error.xyz[i] : low_pass(a, error(axis), now.error.xyz[i]);
    now.error_rate.xyz[i] = low_pass(a, rests ? 0.0 : rate(axis), now.error_rate.xyz[i]);
  }
  // A real thing is held where it stands, sideways as well.
  const Object* object = nearest_object(walk, state);
  const bool real = object != nullptr && object->interaction.kind == Interaction::passive;
  const double across = real ? now.gain : 1.0;
  const Vec3 f = going_along(walk, law.arm, mass) + law.rig.stiffness * now.error.e() +
                 damping_at(law, law.arm.felt_mass(walk.jacobian, mass)) * now.error_rate.e();  // [eq. 2]
  Vec3 wanted = gain_matrix(normal, across, now.gain) * f;                                      // [eq. 7]
  if (const Moved* ball = hit_now(walk, state)) {
    const double back = object->stiffness * ball->firmness * std::max(0.0, ball->depth);
    wanted += normal * ((std::isnan(back) ? 0.0 : back) - normal.dot(wanted));
  }
  walk.wanted_force = Vec<'W'>(wanted);
}

namespace {

// Gravity compensation, as a force of the tip [VisHap eq. 4, 5].
Vec<'R'> against_gravity(const Walk& walk, const Impedance& law) {
  if (law.rig.gravity == GravityForm::none) return Vec<'R'>::zero();
  const Payload form = law.rig.gravity == GravityForm::published ? Payload::published : Payload::exact;
  const PerJoint& q = walk.in.arm.value.joints;
  return law.arm.force(walk.jacobian, law.arm.gravity(q, law.prop_mass, form));
}

// What the law asks for, as far as the machine can. Gravity is held in full; of the rest each motor gives
// what it has, and the direction stays.
Vec3 guarded(Walk& walk, const Impedance& law, const Heat& heat, const Vec3& force) {
  if (!force.allFinite()) {
    walk.why |= kNotFinite;
    return Vec3::Zero();
  }
  const PerJoint held = law.arm.torque(walk.jacobian, walk.arm_force);
  const PerJoint wanted = law.arm.torque(walk.jacobian, walk.scene.X_WR.inverse() * Vec<'W'>(force));
  MotorLimit limit = MotorLimit::none;
  double share = law.motors.share(heat, held, wanted, limit);
  if (share * force.norm() >
      law.rig.peak) {  // where levers are short the motors could do more than the sheet says
    share = law.rig.peak / force.norm();
    limit = MotorLimit::peak;
  }
  if (limit == MotorLimit::peak) walk.why |= kOverload;
  if (limit == MotorLimit::heat) walk.why |= kHot;
  return share * force;
}

}  // namespace

void guard(Walk& walk, const Impedance& law, CommonState& state, Meeting& memory) noexcept {
  // Where nothing is known of the machine nothing is said to it; what is withheld warms nothing, either.
  PerJoint torque{};
  if (walk.X_WH.valid()) {
    walk.arm_force = against_gravity(walk, law);
    walk.felt = Vec<'W'>::zero();
    const Tame tame(walk, law, state, memory);  // between the law and what the machine can
    if (!holding(walk)) {
      const Vec3 pushed = guarded(walk, law, memory.heat, tame.wanted);
      tame.held(walk, memory, pushed);
      walk.felt = Vec<'W'>(Vec3(-pushed));
      walk.arm_force = walk.arm_force + walk.scene.X_WR.inverse() * Vec<'W'>(pushed);  // [eq. 6]
    }
    state.force = walk.felt;
    if (!walk.in.withheld) torque = law.arm.torque(walk.jacobian, walk.arm_force);
  }
  law.motors.warm(memory.heat, torque);
}

}  // namespace enc::stages
