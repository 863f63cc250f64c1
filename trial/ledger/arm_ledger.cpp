#include "trial/ledger/arm_ledger.h"

#include <algorithm>
#include <cmath>

#include "core/control/task/impedance/impedance.h"
#include "sim/spec/arm_spec.h"

namespace enc::trial {
namespace {

// Ratio of the stiffness along the normal to that of the free tip, and distance of the target behind the
// surface.
struct StaticGain {
  double gain, sunk;
};
StaticGain static_at(const LawAt& law, double depth) {
  if (!law.felt) return {1.0, 0.0};
  const RenderedStiffness felt =
      felt_at(law.object->interaction, law.object->stiffness, law.stiffness, std::max(0.0, depth));
  return {felt.stiffness * law.firmness / law.stiffness, felt.sunk};
}

double along(const LawAt& law, double depth) {
  const StaticGain at = static_at(law, depth);
  return at.gain * law.stiffness * (depth - at.sunk);
}

double ball_push(const LawAt& law, double depth) {
  return law.object->stiffness * law.firmness * std::max(0.0, depth);
}

}  // namespace

LawAt law_at(const Glance& glance, const Impedance& law) {
  LawAt at;
  const State& state = *glance.state;
  const ImpedanceState& now = recall<ImpedanceState>(state);
  at.live = glance.out.mode != Mode::hold && glance.out.arm.force.finite() && now.aim.target.finite();
  if (!at.live) return at;
  const bool contact = state.mode == Mode::contact;
  at.object = state.object < 0 ? nullptr : &glance.scene.objects[static_cast<std::size_t>(state.object)];
  // The object's stiffness outlasts a contact that a picture ended (aim.cpp).
  const bool acts = contact || (state.mode == Mode::follow && now.contact.loaded > Time{});
  at.felt = acts && at.object != nullptr && at.object->stiffness > 0.0;
  at.real = at.object != nullptr && at.object->interaction.kind == Interaction::passive;
  at.hit = contact && at.object != nullptr && at.object->interaction.kind == Interaction::hit;
  if (glance.out.arm.prop_facing.finite()) at.normal = (glance.scene.X_WR * glance.out.arm.prop_facing).e();
  at.target = now.aim.target.e();
  at.target_velocity = now.aim.velocity.e();
  at.gain = now.aim.gain;
  at.sunk = now.aim.sunk;
  if (at.object != nullptr && at.object->moving >= 0 && contact) {
    const MoverState& moved = moved_in(state)[static_cast<std::size_t>(at.object->moving)];
    at.firmness = moved.firmness;
    // The surface at the tick that measured this depth: the ball has moved on since.
    const Point<'W'> tip = glance.scene.X_WR * glance.in.arm.value.tip;
    at.ball = tip.e() + moved.depth * at.normal;
  }
  at.stiffness = law.rig.stiffness;
  return at;
}

double ball_depth(const LawAt& law, const Vec3& tip) { return law.normal.dot(law.ball - tip); }

Vec3 asked_force(const LawAt& law, const Vec3& error, const Vec3& rate, double depth) {
  const Vec3 f = law.along + law.stiffness * error + law.damping * rate;
  Vec3 force = gain_matrix(law.normal, law.real ? law.gain : 1.0, law.gain) * f;
  if (law.hit)
    force += law.normal * ((std::isnan(depth) ? 0.0 : ball_push(law, depth)) - law.normal.dot(force));
  return force;
}

Vec3 ideal_force(const LawAt& law, const TipAt& tip) {
  if (!law.live) return Vec3::Zero();
  const Vec3 error = law.target - tip.at;
  const StaticGain at = static_at(law, law.normal.dot(error));
  LawAt ideal = law;
  ideal.gain = at.gain;
  return asked_force(ideal, error - at.sunk * law.normal, law.target_velocity - tip.velocity,
                     ball_depth(law, tip.at));
}

double damped(const LawAt& law, const TipAt& tip) {
  if (!law.live) return 0.0;
  const Vec3 rate = law.target_velocity - tip.velocity;
  const double out = law.normal.dot(rate);
  const double gain = static_at(law, law.normal.dot(law.target - tip.at)).gain;
  const double across = law.real ? gain : 1.0;
  return law.damping * (across * (rate.squaredNorm() - out * out) + (law.hit ? 0.0 : gain) * out * out);
}

double stored(const LawAt& law, const TipAt& tip, int parts) {
  if (!law.live) return 0.0;
  const Vec3 error = law.target - tip.at;
  const double depth = law.normal.dot(error);
  const double across = law.real ? static_at(law, depth).gain : 1.0;
  double sum = 0.5 * across * law.stiffness * (error.squaredNorm() - depth * depth);
  if (law.hit) {
    const double pressed = std::max(0.0, ball_depth(law, tip.at));
    return sum + 0.5 * ball_push(law, pressed) * pressed;
  }
  const double h = depth / parts;
  for (int i = 0; i < parts; ++i)
    sum += h / 6.0 * (along(law, i * h) + 4.0 * along(law, (i + 0.5) * h) + along(law, (i + 1) * h));
  return sum;
}

LawAt between(const LawAt& a, const LawAt& b) {
  LawAt mean = b;
  if (!a.live || !b.live || a.object != b.object || a.felt != b.felt) return a;
  mean.target = 0.5 * (a.target + b.target);
  mean.target_velocity = 0.5 * (a.target_velocity + b.target_velocity);
  mean.normal = (a.normal + b.normal).normalized();
  mean.ball = 0.5 * (a.ball + b.ball);
  mean.firmness = 0.5 * (a.firmness + b.firmness);
  mean.damping = 0.5 * (a.damping + b.damping);
  mean.along = a.along;
  return mean;
}

namespace {

Vec3 vec(const PerJoint& x) { return {x[0], x[1], x[2]}; }

double kinetic_energy(const Arm& machine, double prop, const PerJoint& joints, const PerJoint& rates) {
  const Vec3 v = vec(rates);
  return 0.5 * v.dot(machine.mass(joints, prop) * v);
}

}  // namespace

ArmLedger::ArmLedger(const models::Setup& setup)
    : machine_(sim::true_machine(setup.twin.arm)),
      prop_mass_(setup.scene.prop ? setup.scene.prop->mass : 0.0),
      window_(std::clamp<std::int64_t>(std::llround(setup.twin.arm.velocity_window * setup.rig.loop.rate), 1,
                                       static_cast<std::int64_t>(kRing) - 1)) {}

// The core's request for the true state: passes the true state through the core's filters.
void ArmLedger::filter(const Glance& glance, const Impedance& law, const std::optional<TickState>& was,
                       TickState& now) {
  const Aim& aim = recall<ImpedanceState>(*glance.state).aim;
  if (!was || !was->law.live) {
    error_ = aim.error.e();
    rate_ = aim.error_rate.e();
  } else {
    const std::int64_t back = std::min(window_, reads_ - 1);
    const PerJoint& past =
        read_[static_cast<std::size_t>((reads_ - 1 - back) % static_cast<std::int64_t>(kRing))];
    const Vec3 mean =
        back > 0 ? Vec3((vec(now.joints) - vec(past)) / (static_cast<double>(back) * glance.scene.dt))
                 : Vec3(Vec3::Zero());
    const Vec3 velocity = now.jacobian * mean;
    const Vec3 error = now.law.target - now.tip.at - now.law.sunk * now.law.normal;
    const Vec3 rate = now.law.target_velocity - velocity;
    for (int i = 0; i < 3; ++i) {
      error_(i) = low_pass(law.filter_gain, error(i), error_(i));
      rate_(i) = low_pass(law.filter_gain, rate(i), rate_(i));
    }
  }
  now.late = asked_force(now.law, error_, rate_, ball_depth(now.law, now.tip.at));
  double depth = kUnset;
  if (now.law.hit) depth = moved_in(*glance.state)[static_cast<std::size_t>(now.law.object->moving)].depth;
  now.counted = asked_force(now.law, aim.error.e(), aim.error_rate.e(), depth);
}

const ArmLedger::Posture& ArmLedger::posture(const PerJoint& q, const Impedance& law) {
  if (q == posture_.joints) return posture_;
  const Mat3 J = law.arm.jacobian(q);
  posture_ = {q, {}, J, Vec3::Zero(), damping_at(law, law.arm.felt_mass(J, law.arm.mass(q, law.prop_mass)))};
  if (law.rig.gravity == GravityForm::none) return posture_;
  const Payload form = law.rig.gravity == GravityForm::published ? Payload::published : Payload::exact;
  const Vec<'R'> held_up = law.arm.force(J, law.arm.gravity(q, law.prop_mass, form));
  posture_.against_weight = held_up.e();
  posture_.compensated = law.arm.torque(J, held_up);
  return posture_;
}

bool ArmLedger::tick(const Glance& glance) {
  dt_ = glance.scene.dt;
  read_[static_cast<std::size_t>(reads_++ % static_cast<std::int64_t>(kRing))] = glance.truth.joints;
  return true;
}

void ArmLedger::rest(const Glance& glance) { aim_ = recall<ImpedanceState>(*glance.state).aim; }

ArmLedger::TickState ArmLedger::know(const Glance& glance, const std::optional<TickState>& was) {
  const Impedance& law = impedance_of(glance.scene);
  TickState now;
  now.joints = glance.truth.joints;
  now.rates = glance.truth.work.rates;
  const Pose<'W', 'R'>& X_WR = glance.scene.X_WR;
  const Mat3 turn = X_WR.q().toRotationMatrix();
  now.jacobian = turn * law.arm.jacobian(now.joints);
  now.tip = {(X_WR * law.arm.tip(now.joints)).e(), now.jacobian * vec(now.rates)};
  now.weight = machine_.gravity(now.joints, prop_mass_, Payload::exact);
  now.law = law_at(glance, law);
  now.held = now.late = now.counted = now.given = Vec3::Zero();
  if (now.law.live) tell(glance, law, was, now);
  aim_ = recall<ImpedanceState>(*glance.state).aim;
  return now;
}

// The law's commands to the motors, beginning with its ideal form.
void ArmLedger::tell(const Glance& glance, const Impedance& law, const std::optional<TickState>& was,
                     TickState& now) {
  const Pose<'W', 'R'>& X_WR = glance.scene.X_WR;
  const Mat3 turn = X_WR.q().toRotationMatrix();
  const PerJoint& q = glance.in.arm.value.joints;
  const Posture& at = posture(q, law);
  now.law.damping = at.damping;
  now.compensated = at.compensated;
  const Aim& aim = recall<ImpedanceState>(*glance.state).aim;
  Vec3 change = (aim.velocity.e() - aim_.velocity.e()) / glance.scene.dt;
  // A target that jumped is on its way from this tick on. A target that accelerates in a contact only moves
  // sideways (core/control/task/impedance/aim.cpp).
  const bool on_its_way = !(aim_.caught_up && aim.caught_up);
  now.law.on_its_way = on_its_way;
  if (!on_its_way && glance.out.mode == Mode::contact) change -= now.law.normal * now.law.normal.dot(change);
  if ((on_its_way || aim.hurried) && !now.law.hit && !change.isZero())
    now.law.along = turn * law.arm
                               .force_to_accelerate(at.jacobian, law.arm.mass(q, law.prop_mass),
                                                    X_WR.inverse() * Vec<'W'>(change))
                               .e();
  now.held = ideal_force(now.law, now.tip);
  filter(glance, law, was, now);
  now.given = turn * (glance.out.arm.force.e() - at.against_weight);
  now.jacobian = turn * at.jacobian;  // the motors are commanded with this Jacobian
}

// The ideal law along the tip's path: the cubic through both ends, by Simpson's rule.
void ArmLedger::count_ideal(const TickState& was, const TickState& now, const Vec3& led) {
  const double h = dt_;
  const Vec3 way = now.tip.at - was.tip.at;
  const TipAt middle{0.5 * (was.tip.at + now.tip.at) + h / 8.0 * (was.tip.velocity - now.tip.velocity),
                     1.5 * way / h - 0.25 * (was.tip.velocity + now.tip.velocity)};
  const LawAt law = between(was.law, now.law);
  LawAt then = now.law;
  then.along = was.law.along;
  const auto power = [](const LawAt& l, const TipAt& tip) { return ideal_force(l, tip).dot(tip.velocity); };
  ideal_ += h / 6.0 * (power(was.law, was.tip) + 4.0 * power(law, middle) + power(then, now.tip));
  led_ideal_ +=
      led.dot(ideal_force(was.law, was.tip) + 4.0 * ideal_force(law, middle) + ideal_force(then, now.tip)) /
      6.0;
  sum_.law += h / 6.0 * (damped(was.law, was.tip) + 4.0 * damped(law, middle) + damped(then, now.tip));
}

void ArmLedger::count(const TickState& was, const TickState& now, const sim::Work& work) {
  const Vec3 turned = vec(now.joints) - vec(was.joints);
  const Vec3 moved = was.jacobian * turned;
  sum_.hand += work.contact;
  sum_.joints += work.friction + work.viscous;
  const double compensated = vec(was.compensated).dot(turned);
  sum_.weight += 0.5 * (vec(was.weight) + vec(now.weight)).dot(turned) - compensated;
  work_held_ += was.held.dot(moved);
  work_late_ += was.late.dot(moved);
  work_counted_ += was.counted.dot(moved);
  work_given_ += work.motors - compensated;
  // Work along the target's motion counts as carried, including the feed-forward. A jump of the target is not
  // a motion.
  const bool leaps = !(was.law.live && now.law.live) || (now.law.on_its_way && !was.law.on_its_way);
  const Vec3 led = leaps ? Vec3(Vec3::Zero()) : Vec3(now.law.target - was.law.target);
  led_held_ += was.held.dot(led);
  led_late_ += was.late.dot(led);
  led_counted_ += was.counted.dot(led);
  count_ideal(was, now, led);
  const Vec3 lead = asked_force(was.law, Vec3::Zero(), Vec3::Zero(), kUnset);
  left_ -= work.motors - compensated - was.given.dot(led) - lead.dot(moved - led);
  constexpr int kEachTick = 40;
  const double spring = stored(now.law, now.tip, kEachTick);
  if (leaps) left_ += std::max(0.0, spring - spring_);  // the target loaded the spring
  if (now.law.felt) left_ = std::min(left_, spring);    // keep it in a gap between two tiles
  spring_ = spring;
  if (sum_.hand == 0.0) left_ = std::max(0.0, left_);  // the machine's own motion took it
  sum_.surplus = std::max(sum_.surplus, -left_);
}

void ArmLedger::open(const TickState& from) {
  sum_ = ContactLedger{};
  first_ = from;
  ideal_ = work_held_ = work_late_ = work_counted_ = work_given_ = 0.0;
  spring_ = stored(from.law, from.tip);
  left_ = from.law.on_its_way ? spring_ : 0.0;
  led_ideal_ = led_held_ = led_late_ = led_counted_ = 0.0;
}

ContactLedger ArmLedger::so_far(const TickState& last) const {
  ContactLedger sum = sum_;
  sum.kinetic = kinetic_energy(machine_, prop_mass_, last.joints, last.rates) -
                kinetic_energy(machine_, prop_mass_, first_.joints, first_.rates);
  sum.spring = stored(last.law, last.tip) - stored(first_.law, first_.tip);
  sum.carried = ideal_ + sum.spring + sum.law + led_counted_ - led_ideal_;
  sum.sampling = work_held_ - led_held_ - (ideal_ - led_ideal_);
  sum.delay = work_late_ - led_late_ - (work_held_ - led_held_);
  sum.quantisation = work_counted_ - led_counted_ - (work_late_ - led_late_);
  sum.limits = work_given_ - work_counted_;
  return sum;
}

}  // namespace enc::trial
