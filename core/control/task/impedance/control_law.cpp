// Depth in, force out [VisHap eq. 2, 3, 7], and the part of that force that the motors exert [VisHap eq. 4 to
// 6].
#include <algorithm>
#include <cmath>

#include "core/control/task/impedance/finger.h"
#include "core/control/task/impedance/impedance.h"
#include "core/control/task/impedance/impedance_spec.h"
#include "core/control/task/impedance/impedance_task.h"

namespace enc::stages {
namespace {

// The passivity controller of an arm, along the normal of the touched object: it acts between the law and the
// machine's limits. Internal to the core.
//
// It observes the tip relative to the law's target, along the mean normal of two ticks. So the motion of a
// target neither adds nor takes energy: an object may carry the target, or it follows its path or runs over a
// round object. The same holds for a normal that turns under a sliding tip.
struct PassivityLimiter {
  // Limits the force that the law asks for.
  PassivityLimiter(ArmContext& context, const Impedance& law, const CommonState& state,
                   ImpedanceState& memory) noexcept;
  // Stores the push after all limits.
  void held(const ArmContext& context, ImpedanceState& memory, const Vec3& pushed) const noexcept;
  Vec3 wanted;
  double taken = 0.0;  // N, outward force taken from the law's
};

// J, energy of the law's spring: far more than a prop on its way stores while no finger presses it. Chosen.
constexpr double kPressed = 2e-3;

// m and N: depth and push of the law's spring along the normal at this tick.
struct Spring {
  double depth, push;
};
Spring spring_of(const ArmContext& context, const Impedance& law, const CommonState& state,
                 const ImpedanceState& now, const Object& object) {
  if (const MoverState* ball = hit_now(context, state)) {
    const double depth = std::isnan(ball->depth) ? 0.0 : std::max(0.0, ball->depth);
    return {depth, object.stiffness * ball->firmness * depth};
  }
  const double depth = dot(now.aim.target - context.X_WH.origin(), context.normal);
  return {depth, now.aim.gain * law.rig.stiffness * (depth - now.aim.sunk)};
}

// m: outward motion of the tip relative to its target. The target of a ball moves with the tip, so there it
// is relative to the ball.
double moved(const ArmContext& context, const CommonState& state, const ImpedanceState& memory) {
  const PassivityControl& now = memory.passivity;
  const double dt = context.scene.dt;
  const bool on = now.energy.on;
  const Vec3 way = on ? Vec3((context.X_WH.origin() - now.tip).e()) : Vec3(dt * context.tip_velocity.e());
  const Vec3 normal = on ? Vec3(0.5 * (context.normal.e() + now.normal.e())) : Vec3(context.normal.e());
  Vec3 other = on ? Vec3((memory.aim.target - now.target).e()) : Vec3(dt * memory.aim.velocity.e());
  if (const MoverState* ball = hit_now(context, state)) other = dt * ball->velocity.e();
  return normal.dot(way - other);
}

// A contact that is lost while the tip is inside, and found again, keeps its remaining energy: a new start
// gives the law no new credit. Once the tip has been outside, no deficit remains.
void lose(const ArmContext& context, const ImpedanceState& memory, PassivityControl& now) {
  if (now.energy.on) now.kept = now.energy.left;
  now.energy = Passivity{};
  const bool known = !holding(context) && context.normal.finite() && memory.aim.target.finite();
  if (known && dot(memory.aim.target - context.X_WH.origin(), context.normal) <= 0.0) {
    now.kept = 0.0;
    now.pressed = false;
  }
}

// A law whose force is not sent gives out no energy. A prop on its way to the touch renders nothing either; a
// prop that jumps under the finger that presses it has already arrived.
const Object* controlled_object(const ArmContext& context, const CommonState& state,
                                const ImpedanceState& memory) {
  if (state.mode != Mode::contact || context.in.withheld || holding(context)) return nullptr;
  const bool met = memory.passivity.pressed && memory.passivity.object == state.object;
  if (!memory.aim.caught_up && !met) return nullptr;
  const Object* object = nearest_object(context, state);
  const bool renders = object != nullptr && object->interaction.kind != Interaction::passive;
  const bool known = context.along_mass > 0.0 && context.law_force.finite() && context.normal.finite();
  return renders && known ? object : nullptr;
}

PassivityLimiter::PassivityLimiter(ArmContext& context, const Impedance& law, const CommonState& state,
                                   ImpedanceState& memory) noexcept
    : wanted(context.law_force.e()) {
  if (law.rig.passivity == PassivityForm::none) return;
  PassivityControl& now = memory.passivity;
  const Object* object = controlled_object(context, state, memory);
  if (object == nullptr) {
    lose(context, memory, now);
    return;
  }
  if (now.energy.on && now.object != state.object) lose(context, memory, now);
  const Spring spring = spring_of(context, law, state, memory, *object);
  const PassivityTick tick{moved(context, state, memory), spring.depth, spring.push};
  if (!now.energy.on) {
    begin(now.energy, tick, now.kept);
    now.kept = 0.0;
  } else {
    if (dot(context.normal, now.normal) < MeetSpec::kTurned) renew(now.energy, tick);
    observe(now.energy, tick, law.count);
  }
  now.pressed = (now.pressed && now.object == state.object) || now.energy.stored > kPressed;
  now.object = state.object;
  now.tip = context.X_WH.origin();
  now.target = memory.aim.target;
  now.normal = context.normal;
  const double dt = context.scene.dt, asked = wanted.dot(context.normal.e());
  const double given = passive(now.energy, asked, dt * dt / (2.0 * context.along_mass), law.count);
  if (given == asked) return;
  context.why |= kPassive;
  wanted += (given - asked) * context.normal.e();
  taken = std::clamp(asked, -law.rig.peak, law.rig.peak) - std::clamp(given, -law.rig.peak, law.rig.peak);
}

void PassivityLimiter::held(const ArmContext& context, ImpedanceState& memory,
                            const Vec3& pushed) const noexcept {
  if (!memory.passivity.energy.on) return;
  const double push = pushed.dot(context.normal.e());
  hold(memory.passivity.energy, push, push + taken);
}

// While the finger is far, the arm is motionless [VisHap 2]: the law stops and friction holds the arm. One
// count of an encoder is 0.03 mm and 14 mm/s: at the edge between two counts the law alone would keep the tip
// dithering. The arm must have stood before: the filtered rate dies out in 40 ms without a count. If the arm
// only reverses, friction would not hold the push that follows.
bool resting(const CommonState& state, const Aim& now, const Vec3& error, const Vec3& velocity) {
  return state.mode == Mode::away && error.norm() < RestSpec::kNear && velocity.norm() < RestSpec::kCounts &&
         now.velocity.norm() < RestSpec::kTargetStill && now.error_rate.norm() < RestSpec::kStood;
}

// True if the arm rests and stays at its resting place. If it leaves that place although its target does not
// move, the law continues until the arm stands again with its full push. A count that changes after that does
// not restart it.
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

// Share of a resting arm's push that remains after a tick. Friction may just hold that push, and the push
// could turn a joint further once the tip has crept; friction surely holds a smaller one. So the push fades
// if gravity compensation holds the weight. If the tip has slipped meanwhile, the weight has changed and
// friction does not hold the difference: then the push stays.
double fading(const Impedance& law, const Aim& now, double dt) {
  return law.rig.gravity == GravityForm::exact && !now.slipped ? 1.0 / (1.0 + dt / RestSpec::kFades) : 1.0;
}

// The second derivative of e [eq. 2] is known only for the target: this is the force that the arm needs to
// follow it. It is no measurement and needs no filter: through the filter of eq. 3 it would come late and
// overshoot.
Vec3 going_along(const ArmContext& context, const Arm& arm, const Mat3& mass) {
  if (context.target_acceleration.isZero()) return Vec3::Zero();
  const Pose<'W', 'R'>& X_WR = context.scene.X_WR;
  const Vec<'R'> wanted = X_WR.inverse() * Vec<'W'>(context.target_acceleration);
  return (X_WR * arm.force_to_accelerate(context.jacobian, mass, wanted)).e();
}

}  // namespace

void render_impedance(ArmContext& context, const Impedance& law, CommonState& state,
                      ImpedanceState& memory) noexcept {
  if (!context.X_WH.valid() || holding(context)) return;
  Aim& now = memory.aim;
  const Vec3 normal = context.normal.finite() ? Vec3(context.normal.e()) : Vec3(Vec3::UnitZ());
  const Vec3 error = (now.target - context.X_WH.origin()).e() - now.sunk * normal;
  const Vec3 rate = (now.velocity - context.tip_velocity).e();
  const bool rests =
      stays(state, context.X_WH.origin(), resting(state, now, error, context.tip_velocity.e()), error, now);
  const double fade = fading(law, now, context.scene.dt);
  const Mat3 mass = law.arm.mass(context.in.arm.value.joints, law.prop_mass);
  if (law.rig.passivity == PassivityForm::controlled && context.normal.finite())
    context.along_mass =
        law.arm.felt_mass(context.jacobian, mass, context.scene.X_WR.inverse() * context.normal);
  const double a = law.filter_gain;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    now.error.xyz[i] = rests ? fade * now.error.xyz[i] : low_pass(a, error(axis), now.error.xyz[i]);
    now.error_rate.xyz[i] = low_pass(a, rests ? 0.0 : rate(axis), now.error_rate.xyz[i]);
  }
  // A real object is held in place, sideways as well.
  const Object* object = nearest_object(context, state);
  const bool real = object != nullptr && object->interaction.kind == Interaction::passive;
  const double across = real ? now.gain : 1.0;
  const Vec3 f = going_along(context, law.arm, mass) + law.rig.stiffness * now.error.e() +
                 damping_at(law, law.arm.felt_mass(context.jacobian, mass)) * now.error_rate.e();  // [eq. 2]
  Vec3 wanted = gain_matrix(normal, across, now.gain) * f;                                         // [eq. 7]
  if (const MoverState* ball = hit_now(context, state)) {
    const double back = object->stiffness * ball->firmness * std::max(0.0, ball->depth);
    wanted += normal * ((std::isnan(back) ? 0.0 : back) - normal.dot(wanted));
  }
  context.law_force = Vec<'W'>(wanted);
}

namespace {

// Gravity compensation, as a force of the tip [VisHap eq. 4, 5].
Vec<'R'> against_gravity(const ArmContext& context, const Impedance& law) {
  if (law.rig.gravity == GravityForm::none) return Vec<'R'>::zero();
  const Payload form = law.rig.gravity == GravityForm::published ? Payload::published : Payload::exact;
  const PerJoint& q = context.in.arm.value.joints;
  return law.arm.force(context.jacobian, law.arm.gravity(q, law.prop_mass, form));
}

// The law's force, as far as the machine can exert it. Gravity is compensated in full. Each motor adds what
// it has left, and the force keeps its direction.
Vec3 guarded(ArmContext& context, const Impedance& law, const Heat& heat, const Vec3& force) {
  if (!force.allFinite()) {
    context.why |= kNotFinite;
    return Vec3::Zero();
  }
  const PerJoint held = law.arm.torque(context.jacobian, context.commanded_force);
  const PerJoint wanted = law.arm.torque(context.jacobian, context.scene.X_WR.inverse() * Vec<'W'>(force));
  MotorLimit limit = MotorLimit::none;
  double share = law.motors.share(heat, held, wanted, limit);
  if (share * force.norm() > law.rig.peak) {  // short levers could exceed the data sheet's force
    share = law.rig.peak / force.norm();
    limit = MotorLimit::peak;
  }
  if (limit == MotorLimit::peak) context.why |= kOverload;
  if (limit == MotorLimit::heat) context.why |= kHot;
  return share * force;
}

}  // namespace

void guard(ArmContext& context, const Impedance& law, CommonState& state, ImpedanceState& memory) noexcept {
  // Without a valid pose, command nothing. A withheld command does not heat the motors either.
  PerJoint torque{};
  if (context.X_WH.valid()) {
    context.commanded_force = against_gravity(context, law);
    context.force_unfiltered = Vec<'W'>::zero();
    const PassivityLimiter limiter(context, law, state, memory);  // between the law and the machine's limits
    if (!holding(context)) {
      const Vec3 pushed = guarded(context, law, memory.heat, limiter.wanted);
      limiter.held(context, memory, pushed);
      context.force_unfiltered = Vec<'W'>(Vec3(-pushed));
      context.commanded_force =
          context.commanded_force + context.scene.X_WR.inverse() * Vec<'W'>(pushed);  // [eq. 6]
    }
    state.force = context.force_unfiltered;
    if (!context.in.withheld) torque = law.arm.torque(context.jacobian, context.commanded_force);
  }
  law.motors.warm(memory.heat, torque);
}

}  // namespace enc::stages
