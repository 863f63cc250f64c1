// Impedance rendering: position in, force out. The control law of an arm that carries a prop to where a
// finger will touch, prepared [VisHap 2.3].
//
//   f = K_p e + K_v de/dt,   e = X_d - H          both low-passed [eq. 2, 3]
//   F = F_gc + Lambda f,     Lambda = R diag(1, 1, lambda_z) R^T    [eq. 6, 7]; z along the surface normal
//
// With a constant lambda_z the law is a spring of lambda_z K_p along the normal.
#pragma once

#include "core/machine/motors.h"
#include "core/spec/arm_rig.h"
#include "core/spec/interaction.h"

namespace enc {

// One step of the low-pass of eq. 3, y = (a x + y_before) / (1 + a). `a` is the discrete coefficient: that of
// a_s / (s + a_s), times dt.
[[nodiscard]] inline double low_pass(double a, double x, double before) {
  return (a * x + before) / (1.0 + a);
}
// Frequency at which the low-pass has the gain 1/sqrt(2), Hz. It is below a_s / 2 pi, because the discrete
// form is the backward difference.
[[nodiscard]] double corner_frequency(double a, double dt);

// Lambda = R diag R^T [eq. 7] about a unit normal: `along` acts on the normal, `across` at right angles to
// it.
[[nodiscard]] Mat3 gain_matrix(const Vec3& normal, double across, double along);

// An arm with its prop and its law.
struct Impedance {
  Arm arm{ArmMachine{}};
  ArmRig rig;
  PropKind prop = PropKind::plate;
  double prop_mass = 0.0;       // kg
  double filter_gain = kUnset;  // a of eq. 3, discrete
  double home_mass = kUnset;    // kg, effective mass of the tip at home
  // Tip motion of one count of each encoder at home, m, at most; used by a passivity controller.
  double count = 0.0;
  Motors motors{};
};

// Stiffness at a depth (N/m), and the target's distance behind the surface that gives it (m): the curve of
// [VisHap Fig 4].
struct Felt {
  double stiffness = 0.0, sunk = 0.0;
};
// `stiffness`: the object's, at the touched place; `free`: K_p, that of an untouched tip.
[[nodiscard]] Felt felt_at(const InteractionSpec& interaction, double stiffness, double free, double depth);

}  // namespace enc
