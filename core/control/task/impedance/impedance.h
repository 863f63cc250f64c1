// Impedance rendering: position in, force out. The control law of an arm that carries a prop to where a
// finger will touch, prepared [VisHap 2.3].
//
//   f = K_p e + K_v de/dt,   e = X_d - H          both low-passed [eq. 2, 3]
//   F = F_gc + Lambda f,     Lambda = R diag(1, 1, lambda_z) R^T    [eq. 6, 7]; z along the surface normal
//
// With a constant lambda_z the law is a spring of lambda_z K_p along the normal.
#pragma once

#include "core/control/safety/certificate/bounds.h"
#include "core/machine/motors.h"
#include "core/spec/interaction.h"
#include "core/spec/rendering_rig.h"

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
struct RenderedStiffness {
  double stiffness = 0.0, sunk = 0.0;
};
// `stiffness`: the object's, at the touched place; `free`: K_p, that of an untouched tip.
[[nodiscard]] RenderedStiffness felt_at(const InteractionSpec& interaction, double stiffness, double free,
                                        double depth);

// The loop of an arm's tip as a certificate needs it (core/control/safety/certificate). It has the effective
// mass, friction and encoder step of a tip that is pushed along a normal and otherwise free. It also has the
// tip's motion in all directions, and the law there. Used at set-up.
//
//   qd = M^-1 J^T n m,  m = 1 / (n^T J M^-1 J^T n)      joint rates for each m/s of the tip along n
//   b = qd^T D qd,  f_c = sum of |qd_i| c_i             viscous damping and dry friction
//   W W^T = J M^-1 J^T,  C = R^T D R,  R = M^-1 J^T (J M^-1 J^T)^-1 W     certificate::Directions
//   step = sum of |n . J_i| of a count of each joint    worst-case quantisation step of the tip
struct ArmLoopAt {
  certificate::SampledLoop loop;
  certificate::Steps steps;
  certificate::Request asked;
};

// The loop at joints `q`, along `way` (unit, in R), with `stiffness` (N/m) in that direction. One gain
// scales K_p to the stiffness, and K_v by the same factor [VisHap eq. 2, 7]. Sideways the law is that of a
// free tip. `kind` matters for `hit` (a flying ball: along the normal a spring without damper
// and filter) and for `passive` (a real object: the gain acts in all directions). Figures of the loop that
// the rig does not give are NaN.
[[nodiscard]] ArmLoopAt loop_at(const Impedance& law, const certificate::Hand& hand, double dt,
                                const PerJoint& q, const Vec<'R'>& way, double stiffness, Interaction kind);

// K_v of eq. 2 with the damping ratio that it has at home, N s/m; close to its base the arm's tip has twice
// the effective mass. `mass`: effective mass at the tip, kg.
[[nodiscard]] double damping_at(const Impedance& law, double mass);

}  // namespace enc
