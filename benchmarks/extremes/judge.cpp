#include <algorithm>
#include <cmath>

#include <Eigen/SVD>
#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "core/record/fields.h"

namespace enc::bench::extremes {
namespace {

// A visitor: an infinite number is always wrong; NaN means unset.
struct InfinityCheck {
  std::string_view where;
  template <class T>
  void operator()(std::string_view name, T& x) {
    if constexpr (std::is_same_v<T, double>)
      if (std::isinf(x) && where.empty()) where = name;
  }
};

// Condition number of the Jacobian, rotations scaled by the platform's radius: without a unit.
double condition_of(const Hexapod& machine, const Pose<'R', 'H'>& pose) {
  Hexapod::Jacobian scaled = machine.jacobian(pose);
  scaled.rightCols<3>() /= machine.geometry().platform_radius;
  const auto values = Eigen::JacobiSVD<Hexapod::Jacobian>(scaled).singularValues();
  return values(0) / values(5);
}

}  // namespace

void Judge::wrong(const trial::Glance& glance, const std::string& what) {
  wrong_now_ = true;
  if (first_.empty()) first_ = fmt::format("{} at {:.3f} s", what, seconds(glance.tick.t.time_since_epoch()));
}

void Judge::see(const trial::Glance& glance) {
  wrong_now_ = false;
  judge_time(glance);
  judge_numbers(glance);
  if (const Impedance* law = glance.scene.impedance())
    judge_arm(glance, *law);
  else
    judge_machine(glance);
  touch = std::max(touch, glance.truth.contact_force.norm());
  if (glance.out.mode == Mode::hold) {
    ++held;
    reasons |= glance.out.why & kHoldReasons;
  }
  ++ticks;
  broken_ += wrong_now_ ? 1 : 0;
}

// Each tick follows the last one, at the time of its number to the nanosecond; the twin's time advances with
// it.
void Judge::judge_time(const trial::Glance& glance) {
  const Tick& tick = glance.tick;
  if (tick.index <= index_) wrong(glance, "the number of the tick fell");
  if (tick.t.time_since_epoch() != tick.index * tick.dt) wrong(glance, "the time is not that of its tick");
  if (glance.truth.t < truth_) wrong(glance, "the twin's time went back");
  index_ = tick.index;
  truth_ = glance.truth.t;
}

void Judge::judge_numbers(const trial::Glance& glance) {
  Outputs out = glance.out;
  if (unsound && ticks == 100) out.deflection = kInfinite;
  InfinityCheck infinite;
  fields(infinite, out);
  if (!infinite.where.empty()) wrong(glance, fmt::format("'{}' is infinite", infinite.where));
  const sim::Truth& truth = glance.truth;
  if (!truth.tip.finite() || !truth.tip_velocity.finite() || !truth.contact_force.finite() ||
      (truth.tool >= 0 && !truth.tool_tip.finite()))
    wrong(glance, "the twin is not finite");
}

void Judge::judge_machine(const trial::Glance& glance) {
  const Reach& reach = glance.scene.reach;
  const Pose<'R', 'H'>& tip = glance.out.manipulator.tip;
  if (!tip.valid()) {
    if (told_) wrong(glance, "the command is no pose");
    return;
  }
  const double dt = glance.scene.dt;
  if (told_) {
    const Vec3 velocity = (Vec3(tip.p()) - at_) / dt;
    fastest = std::max(fastest, velocity.norm());
    hardest = std::max(hardest, (velocity - velocity_).norm() / dt);
    if (velocity.norm() > reach.speed * (1.0 + 1e-9))
      wrong(glance, fmt::format("{:.3g} m/s", velocity.norm()));
    if ((velocity - velocity_).norm() > reach.acceleration * dt * (1.0 + 1e-6))
      wrong(glance, fmt::format("{:.3g} m/s2", (velocity - velocity_).norm() / dt));
    velocity_ = velocity;
  }
  if (!reach.contains(tip)) wrong(glance, "the command is out of reach");
  if (ticks % 10 == 0) condition = std::max(condition, condition_of(reach.machine, tip));
  told_ = true;
  at_ = tip.p();
}

// The bound is gravity plus the sheet's peak force, and what the weight adds to that: both at the tip.
void Judge::judge_arm(const trial::Glance& glance, const Impedance& law) {
  const Vec<'R'>& told = glance.out.arm.force;
  const Mat3 jacobian = law.arm.jacobian(glance.truth.joints);
  dexterity = std::min(dexterity, law.arm.dexterity(jacobian));
  if (!told.finite()) {  // all of it unset: no command
    for (const double x : told.xyz)
      if (!std::isnan(x)) wrong(glance, "a part of the command is not set");
    over_ = 0;
    return;
  }
  constexpr double kRounding = 0.05;  // N: the weight at the encoders' joints
  const double weight =
      law.arm.force(jacobian, law.arm.gravity(glance.truth.joints, law.prop_mass, Payload::exact)).norm();
  force = std::max(force, glance.out.force_unfiltered.norm());
  if (!(glance.out.force_unfiltered.norm() <= law.rig.peak * (1.0 + 1e-9)))
    wrong(glance, fmt::format("{:.3g} N", glance.out.force_unfiltered.norm()));
  over_ = told.norm() <= law.rig.peak + weight + kRounding ? 0 : over_ + 1;
  if (over_ > 1) wrong(glance, fmt::format("{:.3g} N for more than a cycle", told.norm()));
}

}  // namespace enc::bench::extremes
