#include "core/arm/motors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace enc {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// How much of `wanted` fits beside `held` within +-most.
double fits(double held, double wanted, double most) {
  const double room = wanted > 0.0 ? most - held : most + held;
  return wanted == 0.0 ? kInfinite : std::max(0.0, room) / std::abs(wanted);
}

}  // namespace

double folded_back(double warmth, double peak, double continuous) noexcept {
  const double cool = std::clamp((1.0 - warmth) / (1.0 - kWarm), 0.0, 1.0);
  return std::min(peak, continuous + cool * (peak - continuous));
}

Warming::Warming(const Thermal& thermal, double dt)
    : winding_(1.0 - std::exp(-dt / thermal.winding_time)),
      housing_(1.0 - std::exp(-dt / thermal.housing_time)),
      share_(thermal.winding_share) {}

void Warming::operator()(double load, double& winding, double& housing) const noexcept {
  const double heat = load * load;
  winding += winding_ * (share_ * heat - winding);
  housing += housing_ * ((1.0 - share_) * heat - housing);
}

double bears_for(const Thermal& thermal, double load) {
  const double heat = load * load;
  const auto warmth = [&](double t) {
    return heat * (thermal.winding_share * (1.0 - std::exp(-t / thermal.winding_time)) +
                   (1.0 - thermal.winding_share) * (1.0 - std::exp(-t / thermal.housing_time)));
  };
  if (heat <= kWarm) return kInfinite;
  double low = 0.0, high = thermal.winding_time + thermal.housing_time;
  while (warmth(high) < kWarm && high < 1e9) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (warmth(middle) < kWarm ? low : high) = middle;
  }
  return high;
}

Motors::Motors(const Arm& arm, const ArmRig& rig, double dt)
    : joints_(arm.joints()), tip_(rig.peak), thermal_(rig.thermal), warming_(rig.thermal, dt) {
  for (std::size_t i = 0; i < joints_; ++i) {
    const double ratio = rig.machine.drives[i].ratio;
    peak_[i] = rig.peak_torque[i] * ratio;
    continuous_[i] = rig.continuous_torque[i] * ratio;
  }
}

double Motors::share(const Heat& heat, const PerJoint& held, const PerJoint& wanted,
                     MotorLimit& limit) const noexcept {
  double share = 1.0;
  limit = MotorLimit::none;
  for (std::size_t i = 0; i < joints_; ++i) {
    const double most = folded_back(heat.of(i), peak_[i], continuous_[i]);
    const double here = fits(held[i], wanted[i], most);
    if (!(here < share)) continue;
    share = here;
    limit = most < peak_[i] ? MotorLimit::heat : MotorLimit::peak;
  }
  return share;
}

void Motors::warm(Heat& heat, const PerJoint& torque) const noexcept {
  for (std::size_t i = 0; i < joints_; ++i)
    warming_(torque[i] / continuous_[i], heat.winding[i], heat.housing[i]);
}

Motors::Strength Motors::strength(const Arm& arm, const PerJoint& q, const PerJoint& held,
                                  const Vec<'R'>& way) const noexcept {
  const PerJoint each = arm.torque(arm.jacobian(q), way);
  Strength found{tip_, tip_};
  for (std::size_t i = 0; i < joints_; ++i) {
    found.peak = std::min(found.peak, fits(held[i], each[i], peak_[i]));
    // For ever is where the winding has folded back to: its torque and its warmth agree.
    double low = 0.0, high = peak_[i];
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      const double load = middle / continuous_[i];
      (folded_back(load * load, peak_[i], continuous_[i]) > middle ? low : high) = middle;
    }
    found.lasting = std::min(found.lasting, fits(held[i], each[i], low));
  }
  return found;
}

double Motors::holds_for(const Arm& arm, const PerJoint& q, const PerJoint& held, const Vec<'R'>& way,
                         double force) const {
  const PerJoint each = arm.torque(arm.jacobian(q), way);
  double time = kInfinite;
  for (std::size_t i = 0; i < joints_; ++i) {
    const double torque = std::abs(held[i] + force * each[i]);
    time = std::min(time, torque > peak_[i] ? 0.0 : bears_for(thermal_, torque / continuous_[i]));
  }
  return time;
}

}  // namespace enc
