#include "sim/plants/arm_plant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/rotation.h"

namespace enc::sim {

ArmPlant::ArmPlant(const ArmTruth& truth, const Arm& believed, double dt)
    : truth_(truth),
      believed_(believed),
      dt_(dt),
      warming_(truth.thermal, dt),
      window_(std::max<std::int64_t>(1, std::llround(truth.velocity_window / dt))) {
  if (window_ >= static_cast<std::int64_t>(kLongestWindow))
    throw Error("the encoders are differenced over " + std::to_string(window_) +
                    " ticks; expected at most 63; lower it",
                "truth.arm.velocity_window");
  for (std::size_t i = 0; i < believed_.joints(); ++i)
    step_[i] = 2.0 * std::numbers::pi / (truth.counts[i] * truth.machine.drives[i].ratio);
}

void ArmPlant::measure(Time t, const PerJoint& joints) noexcept {
  ArmSample& sample = state_.sample.value;
  for (std::size_t i = 0; i < believed_.joints(); ++i)
    sample.joints[i] = step_[i] * std::round(joints[i] / step_[i]);
  constexpr auto kRing = static_cast<std::int64_t>(kLongestWindow);
  state_.read[static_cast<std::size_t>(state_.reads % kRing)] = sample.joints;
  const std::int64_t back = std::min(window_, state_.reads);
  const PerJoint& before = state_.read[static_cast<std::size_t>((state_.reads - back) % kRing)];
  for (std::size_t i = 0; back > 0 && i < believed_.joints(); ++i)
    sample.joint_velocities[i] = (sample.joints[i] - before[i]) / (static_cast<double>(back) * dt_);
  ++state_.reads;
  sample.tip = believed_.tip(sample.joints);
  const PerJoint& v = sample.joint_velocities;
  sample.velocity = Vec<'R'>(Vec3(believed_.jacobian(sample.joints) * Vec3(v[0], v[1], v[2])));
  state_.sample.t = t;
  if (state_.sample.health == Health::absent) state_.sample.health = Health::ok;
}

void ArmPlant::command(const Vec<'R'>& force) noexcept {
  if (!force.finite()) {
    state_.sample.health = Health::fault;
    return;
  }
  state_.sample.health = Health::ok;
  state_.wanted = force;
  state_.silent = 0.0;
  state_.commanded = true;
}

void ArmPlant::move_prop(const PropCommand& prop) noexcept {
  if (std::isfinite(prop.surface_speed)) state_.surface_wanted = prop.surface_speed;
  if (prop.facing.finite() && prop.facing.norm() > 0.5) state_.facing_wanted = prop.facing;
}

// A motor gives at most its peak torque. A warm motor gives less; at the temperature that the continuous
// torque would cause, it gives only the continuous torque.
double ArmPlant::limited(std::size_t i, double torque) noexcept {
  const double ratio = truth_.machine.drives[i].ratio;
  const double continuous = truth_.continuous_torque[i];
  const double most = folded_back(warmth(i), truth_.peak_torque[i], continuous);
  const double given = std::clamp(torque / ratio, -most, most);
  state_.clipped = state_.clipped || given != torque / ratio;
  warming_(given / continuous, state_.winding[i], state_.housing[i]);
  return given * ratio;
}

void ArmPlant::begin_cycle() noexcept {
  const bool live = state_.commanded && state_.silent <= truth_.watchdog;
  const Mat3 J = believed_.jacobian(state_.sample.value.joints);
  const PerJoint wanted = live ? believed_.torque(J, state_.wanted) : PerJoint{};
  state_.clipped = false;
  for (std::size_t i = 0; i < believed_.joints(); ++i) state_.torque[i] = limited(i, wanted[i]);
  state_.silent += dt_;
  state_.surface_speed += (1.0 - std::exp(-dt_ / truth_.drum_time)) *
                          ((live ? state_.surface_wanted : 0.0) - state_.surface_speed);
}

PerJoint ArmPlant::friction(const PerJoint& rates) const noexcept {
  constexpr double kSteep = 10.0;  // s/rad, in the published form
  PerJoint torque{};
  if (truth_.friction_form == ArmFriction::smooth)
    for (std::size_t i = 0; i < believed_.joints(); ++i)
      torque[i] = -truth_.friction[i] * std::tanh(kSteep * rates[i]);
  return torque;
}

PerJoint ArmPlant::motor_torque() const noexcept {
  PerJoint torque{};
  for (std::size_t i = 0; i < believed_.joints(); ++i)
    torque[i] = state_.torque[i] / truth_.machine.drives[i].ratio;
  return torque;
}

void ArmPlant::face(const Vec3& normal, double h, bool at_once) noexcept {
  const Quat wanted = rotation_z_to(normal);
  const double share = at_once ? 1.0 : 1.0 - std::exp(-h / truth_.gimbal_time);
  const Quat now = facing().slerp(share, wanted).normalized();
  state_.facing = {now.x(), now.y(), now.z(), now.w()};
}

}  // namespace enc::sim
