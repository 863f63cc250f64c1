// Rendering by a machine: [admittance] and [arm] of a rig file. Parts of rig_spec.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/words.h"
#include "core/machine/arm.h"
#include "core/machine/motors.h"

namespace enc {

// Treatment of the energy that a law gives out because it is sampled, delayed or quantised (passivity.h).
enum class PassivityForm : std::uint8_t { none, controlled };
constexpr auto words(PassivityForm) { return enum_words("none", "controlled"); }

// Refuses a passivity controller that has nothing to control, for this reason; `key`: of the rig.
[[noreturn]] inline void refuse_passivity(const std::string& why, const std::string& key) {
  throw Error("the passivity controller has nothing to control: " + why + "; expected passivity = 'none'",
              key);
}

enum class Damping : std::uint8_t {
  none,     // the object alone, as on the paper's rig
  observed  // plus a damper, as strong as the measured oscillation energy requires
};
constexpr auto words(Damping) { return enum_words("none", "observed"); }

// [admittance]: rendering by a machine that measures force.
struct AdmittanceRig {
  Damping damping = Damping::none;
  PassivityForm passivity = PassivityForm::none;
  double margin = 2.0;          // damping over sufficient damping
  double calm_time = 1.0;       // s, time constant with which damping decays without an oscillation
  double slowest = 1.0;         // Hz: slower changes are the user's own motion
  double average_time = 0.2;    // s, averaging time of energies
  double least_swing = 20e-6;   // m rms: a smaller motion is not an oscillation
  double most_damping = 500.0;  // N s/m
};

// Gravity compensation.
enum class GravityForm : std::uint8_t {
  none,       // none: the tip sags below its target, and falls without a command
  published,  // eq. 5 with the prop added to m_a
  // Eq. 5 with the prop at its actual place, the tip.
  exact
};
constexpr auto words(GravityForm) { return enum_words("none", "published", "exact"); }

// The figures that limit the stiffness of a wall, by the rig file (docs/reference/stability.md): per joint,
// as in [truth.arm].
struct ArmLoop {
  PerJoint friction{0.01, 0.01, 0.01};       // dry, N m or N
  PerJoint viscous{0.0005, 0.0005, 0.0005};  // N m s/rad or N s/m
  PerJoint counts{4096.0, 4096.0, 4096.0};   // encoder counts for each turn of the motor
  double velocity_window = 0.002;            // s, over which the device differences its encoder readings
  double delay = 0.0;                        // s, from a reading to the force, in addition to the tick's own
};

// [arm]: a force-controlled arm, its model and its control law [VisHap 2.3].
struct ArmRig {
  std::string driver = "none";
  ArmMachine machine;
  GravityForm gravity = GravityForm::exact;
  double stiffness = 300.0;  // K_p of eq. 2, N/m
  double damping = 11.5;     // K_v of eq. 2, N s/m; critical or more for the mass at the tip
  // Corner frequency of the low-pass on e and its rate [eq. 3], Hz: 2 pi f is the `a` of a / (s + a); 2 pi f
  // dt is that of y = (a x + y_before) / (1 + a).
  double filter = 60.0;
  double peak = 8.5;        // N: brief force of the tip [PHANToM sheet]
  double continuous = 1.4;  // N: continuous force of the tip
  // Torque of each motor, N m: brief and continuous (sources/arm 3, published).
  PerJoint peak_torque{0.129, 0.129, 0.129}, continuous_torque{0.0286, 0.0286, 0.0286};
  ThermalModel thermal{};
  double speed = 1.0;          // m/s, of the target on its path to the expected touch
  double acceleration = 15.0;  // m/s^2, of that target
  double settle = 0.020;       // s, in which the target follows a jump of the tracked finger
  // As acceleration and settle, while the target moves to a predicted touch (tracker.foresight): no finger is
  // on the prop yet to feel the motion.
  double reach_acceleration = 30.0, reach_settle = 0.005;
  // s, lag of a driven prop's surface behind its command; assumed.
  double prop_lag = 0.020;
  double stale = 0.005;           // s: an older sample counts as lost
  double least_dexterity = 0.15;  // smallest dexterity of a commanded tip position
  PassivityForm passivity = PassivityForm::none;
  std::optional<ArmLoop> loop{};  // unset: stability is unknown, and no real arm is armed
};

[[nodiscard]] inline MotorRatings motor_ratings(const ArmRig& rig) {
  return {rig.peak, rig.peak_torque, rig.continuous_torque, rig.thermal};
}

// Abilities that an arm reports.
struct ArmAbility {
  ArmMachine machine;
  double peak = kUnset, continuous = kUnset;  // N, tip force at home
};

}  // namespace enc
