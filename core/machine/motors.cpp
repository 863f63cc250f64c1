#include "core/machine/motors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace enc {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Share of `wanted` that fits beside `held` within +-most.
double fits(double held, double wanted, double most) {
  const double room = wanted > 0.0 ? most - held : most + held;
  return wanted == 0.0 ? kInfinite : std::max(0.0, room) / std::abs(wanted);
}

}  // namespace

double folded_back(double warmth, double peak, double continuous) noexcept {
  const double cool = std::clamp((1.0 - warmth) / (1.0 - kWarm), 0.0, 1.0);
  return std::min(peak, continuous + cool * (peak - continuous));
}

MotorHeating::MotorHeating(const ThermalModel& thermal, double dt)
    : winding_(1.0 - std::exp(-dt / thermal.winding_time)),
      housing_(1.0 - std::exp(-dt / thermal.housing_time)),
      share_(thermal.winding_share) {}

void MotorHeating::operator()(double load, double& winding, double& housing) const noexcept {
  const double heat = load * load;
  winding += winding_ * (share_ * heat - winding);
  housing += housing_ * ((1.0 - share_) * heat - housing);
}

double folds_at(double torque, double peak, double continuous) noexcept {
  if (torque >= peak || !(peak > continuous)) return kWarm;
  return 1.0 - (1.0 - kWarm) * std::max(0.0, torque - continuous) / (peak - continuous);
}

double bears_for(const ThermalModel& thermal, double load, double warm) {
  const double heat = load * load;
  const auto warmth = [&](double t) {
    return heat * (thermal.winding_share * (1.0 - std::exp(-t / thermal.winding_time)) +
                   (1.0 - thermal.winding_share) * (1.0 - std::exp(-t / thermal.housing_time)));
  };
  if (heat <= warm) return kInfinite;
  double low = 0.0, high = thermal.winding_time + thermal.housing_time;
  while (warmth(high) < warm && high < 1e9) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (warmth(middle) < warm ? low : high) = middle;
  }
  return high;
}

Motors::Motors(const Arm& arm, const MotorRatings& ratings, double dt)
    : joints_(arm.joints()), tip_(ratings.tip), thermal_(ratings.thermal), warming_(ratings.thermal, dt) {
  for (std::size_t i = 0; i < joints_; ++i) {
    const double ratio = arm.machine().drives[i].ratio;
    peak_[i] = ratings.peak[i] * ratio;
    continuous_[i] = ratings.continuous[i] * ratio;
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
    // The continuous torque is where the folded-back winding settles: its torque and its temperature agree.
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
    const double warm = folds_at(torque, peak_[i], continuous_[i]);
    time = std::min(time, torque > peak_[i] ? 0.0 : bears_for(thermal_, torque / continuous_[i], warm));
  }
  return time;
}

std::int64_t Motors::gives_way_in(const Arm& arm, const PerJoint& q, const PerJoint& held,
                                  const Vec<'R'>& way, double force, const Presses& presses) const {
  constexpr double kStep = 0.02;  // s
  constexpr std::int64_t kMost = 1'000;
  const PerJoint each = arm.torque(arm.jacobian(q), way);
  const MotorHeating warming(thermal_, kStep);
  const auto steps = [](double time) { return static_cast<std::int64_t>(std::ceil(time / kStep)); };
  Heat heat;
  for (std::int64_t press = 1; press <= std::min(presses.number, kMost); ++press) {
    for (std::int64_t k = 0; k < steps(presses.pressed); ++k)
      for (std::size_t i = 0; i < joints_; ++i) {
        const double torque = std::abs(held[i] + force * each[i]);
        if (folded_back(heat.of(i), peak_[i], continuous_[i]) < torque * (1.0 - 1e-9)) return press;
        warming(torque / continuous_[i], heat.winding[i], heat.housing[i]);
      }
    for (std::int64_t k = 0; k < steps(presses.pause); ++k)
      for (std::size_t i = 0; i < joints_; ++i)
        warming(held[i] / continuous_[i], heat.winding[i], heat.housing[i]);
  }
  return 0;
}

}  // namespace enc
