// Limits of an arm's motors: for a short time the peak torque, continuously the torque that the windings
// withstand. As a winding warms up, current fold-back reduces the torque smoothly from peak to continuous.
#pragma once

#include "core/machine/arm.h"

namespace enc {

// Thermal model of a motor.
struct ThermalModel {
  // s, time constant of a winding against its housing (sources/arm 3, published).
  double winding_time = 12.0;
  double housing_time = 612.0;  // s, time constant of the housing against the room (published)
  // Winding's rise over the housing as a share of its rise over the room (published).
  double winding_share = 3.1 / (3.1 + 14.0);
};

// Motor ratings of an arm, as the rig file gives them.
struct MotorRatings {
  double tip = 0.0;               // N: largest tip force anywhere
  PerJoint peak{}, continuous{};  // N m, of each motor: brief and continuous
  ThermalModel thermal{};
};

// Temperature rise of each winding over its housing, and of the housing over the room, as shares of the
// continuously allowed rise of a winding over the room.
struct Heat {
  PerJoint winding{}, housing{};
  [[nodiscard]] double of(std::size_t joint) const { return winding[joint] + housing[joint]; }
};

// Share of the allowed temperature rise at which fold-back begins (assumed).
inline constexpr double kWarm = 0.8;

// Torque limit at a relative temperature: peak, then less, and at 1 the continuous torque.
[[nodiscard]] double folded_back(double warmth, double peak, double continuous) noexcept;
// One tick under a load; load is torque over continuous torque.
class MotorHeating {
 public:
  MotorHeating() = default;
  MotorHeating(const ThermalModel& thermal, double dt);
  void operator()(double load, double& winding, double& housing) const noexcept;

 private:
  double winding_ = 0.0, housing_ = 0.0, share_ = 0.0;  // per tick, per tick, dimensionless
};
// Relative temperature from which a motor gives no more than `torque`, which is between peak and continuous.
[[nodiscard]] double folds_at(double torque, double peak, double continuous) noexcept;
// Time for which a cold motor bears a load until it reaches a relative temperature, s; infinite: never.
[[nodiscard]] double bears_for(const ThermalModel& thermal, double load, double warmth);

// The limit that acts on a force.
enum class MotorLimit : std::uint8_t { none, peak, heat };

// The motors by the rig file's model.
class Motors {
 public:
  Motors() = default;  // no motors: no torque
  Motors(const Arm& arm, const MotorRatings& ratings, double dt);

  // Largest share, 0 to 1, of joint torques `wanted` that is available in addition to `held`.
  [[nodiscard]] double share(const Heat& heat, const PerJoint& held, const PerJoint& wanted,
                             MotorLimit& limit) const noexcept;
  void warm(Heat& heat, const PerJoint& torque) const noexcept;

  // Tip force available along `way` (unit) at joints q, beside gravity, at most the data sheet's peak, N:
  // brief and continuous.
  struct Strength {
    double peak = 0.0, lasting = 0.0;
  };
  [[nodiscard]] Strength strength(const Arm& arm, const PerJoint& q, const PerJoint& held,
                                  const Vec<'R'>& way) const noexcept;
  // Time until the first motor, cold at first, gives less than that force, s; infinite: never.
  [[nodiscard]] double holds_for(const Arm& arm, const PerJoint& q, const PerJoint& held, const Vec<'R'>& way,
                                 double force) const;

  // Number of the press, from 1, in which a motor can no longer give that force; 0: no press. The motors hold
  // only gravity in the pauses.
  struct Presses {
    double pressed = 0.0, pause = 0.0;  // s
    std::int64_t number = 1;
  };
  [[nodiscard]] std::int64_t gives_way_in(const Arm& arm, const PerJoint& q, const PerJoint& held,
                                          const Vec<'R'>& way, double force, const Presses& presses) const;

 private:
  std::size_t joints_ = 0;
  PerJoint peak_{}, continuous_{};  // referred to the joints, N m or N
  double tip_ = 0.0;                // N: largest tip force anywhere
  ThermalModel thermal_;
  MotorHeating warming_;
};

}  // namespace enc
