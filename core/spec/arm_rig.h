// A force-controlled arm as the core sees it: the machine that is believed, and its control law [VisHap 2.3].
// A part of rig_spec.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/machine/arm.h"
#include "core/machine/motors.h"
#include "core/spec/passivity_form.h"

namespace enc {

// What is done against gravity.
enum class GravityForm : std::uint8_t {
  none,       // nothing: the tip hangs from its target, and falls where nothing is commanded
  published,  // eq. 5 with the prop added to m_a
  exact       // and the prop where it is, at the tip
};
constexpr auto words(GravityForm) { return enum_words("none", "published", "exact"); }

// What decides how stiff a wall may be, as it is believed (docs/reference/stability.md): of each joint as in
// [truth.arm].
struct ArmLoop {
  PerJoint friction{0.01, 0.01, 0.01};       // dry, N m or N
  PerJoint viscous{0.0005, 0.0005, 0.0005};  // N m s/rad or N s/m
  PerJoint counts{4096.0, 4096.0, 4096.0};   // of an encoder, for each turn of its motor
  double velocity_window = 0.002;            // s, over which the device differences its encoders
  double delay = 0.0;                        // s, from a reading to the force, beyond the tick's own
};

struct ArmRig {
  std::string driver = "none";
  ArmMachine machine;
  GravityForm gravity = GravityForm::exact;
  double stiffness = 300.0;  // K_p of eq. 2, N/m
  double damping = 11.5;     // K_v of eq. 2, N s/m; critical or more for the mass at the tip
  // Corner of the low-pass on e and its rate [eq. 3], Hz: 2 pi f is the `a` of a / (s + a); 2 pi f dt that of
  // y = (a x + y_before) / (1 + a).
  double filter = 60.0;
  double peak = 8.5;        // N: what the tip can push with [PHANToM sheet]
  double continuous = 1.4;  // N: and for hours
  // Of each motor, N m: for a moment, and for ever (sources/arm 3, published).
  PerJoint peak_torque{0.129, 0.129, 0.129}, continuous_torque{0.0286, 0.0286, 0.0286};
  Thermal thermal{};
  double speed = 1.0;          // of the target on its way to where the finger will touch, m/s
  double acceleration = 15.0;  // and of it, m/s^2
  double settle = 0.020;       // s, in which the target follows a leap of the finger that is seen
  // Likewise, while it goes to where a reach is foreseen to touch (tracker.foresight): there no finger lies
  // on the prop that would feel it.
  double reach_acceleration = 30.0, reach_settle = 0.005;
  double prop_lag = 0.020;        // s: of a driven prop's surface behind what it is told; assumed
  double stale = 0.005;           // s: an older sample is lost
  double least_dexterity = 0.15;  // nearer to a singular pose the tip is not sent
  PassivityForm passivity = PassivityForm::none;
  std::optional<ArmLoop> loop{};  // unset: whether it is stable is not known, and no real one is armed
};

[[nodiscard]] inline MotorRatings motor_ratings(const ArmRig& rig) {
  return {rig.peak, rig.peak_torque, rig.continuous_torque, rig.thermal};
}

// What an arm says that it is and can do.
struct ArmAbility {
  ArmMachine machine;
  double peak = kUnset, continuous = kUnset;  // N, of the tip at home
};

}  // namespace enc
