// The loop of an arm's tip as a certificate needs it (core/control/safety/certificate). It has the effective
// mass, friction and encoder step of a tip that is pushed along a normal and otherwise free. It also has the
// tip's motion in all directions, and the law there. Used at set-up.
//
//   qd = M^-1 J^T n m,  m = 1 / (n^T J M^-1 J^T n)      joint rates for each m/s of the tip along n
//   b = qd^T D qd,  f_c = sum of |qd_i| c_i             viscous damping and dry friction
//   W W^T = J M^-1 J^T,  C = R^T D R,  R = M^-1 J^T (J M^-1 J^T)^-1 W     certificate::Directions
//   step = sum of |n . J_i| of a count of each joint    worst-case quantisation step of the tip
#pragma once

#include "core/control/safety/certificate/bounds.h"
#include "core/control/task/meet/impedance.h"

namespace enc {

struct ArmLoopAt {
  certificate::SampledLoop loop;
  certificate::Steps steps;
  certificate::Asked asked;
};

// The loop at joints `q`, along `way` (unit, in R), with `stiffness` (N/m) in that direction. A gain makes
// the stiffness from K_p and scales K_v as much: a damper in proportion [VisHap eq. 2, 7]. Sideways the law
// is that of a free tip. `kind` matters for `hit` (a flying ball: along the normal a spring without damper
// and filter) and for `passive` (a real object: the gain acts in all directions). Figures of the loop that
// the rig does not give are NaN.
[[nodiscard]] ArmLoopAt loop_at(const Impedance& law, const certificate::Hand& hand, double dt,
                                const PerJoint& q, const Vec<'R'>& way, double stiffness, Interaction kind);

// K_v of eq. 2 with the damping ratio that it has at home, N s/m; close to its base the arm's tip has twice
// the effective mass. `mass`: effective mass at the tip, kg.
[[nodiscard]] double damping_at(const Impedance& law, double mass);

}  // namespace enc
