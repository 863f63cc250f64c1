// The loop of an arm's tip, as a certificate needs it (core/control/safety/certificate): what the tip weighs,
// loses and counts where it is pushed along a normal and nothing else holds it, how it moves in all
// directions, and what the law does there. At set-up.
//
//   qd = M^-1 J^T n m,  m = 1 / (n^T J M^-1 J^T n)      how the joints go for each m/s of the tip along n
//   b = qd^T D qd,  f_c = sum of |qd_i| c_i             what viscous and dry friction take
//   W W^T = J M^-1 J^T,  C = R^T D R,  R = M^-1 J^T (J M^-1 J^T)^-1 W     certificate::Directions
//   step = sum of |n . J_i| of a count of each joint    what encoders cannot tell apart, at worst
#pragma once

#include "core/control/safety/certificate/bounds.h"
#include "core/control/task/meet/impedance.h"

namespace enc {

struct ArmLoopAt {
  certificate::SampledLoop loop;
  certificate::Steps steps;
  certificate::Asked asked;
};

// `way`: unit, in R; `stiffness`: N/m, along it. A gain makes that of K_p, and of K_v as much: a damper in
// proportion [VisHap eq. 2, 7]. Sideways the law is that of the tip that nobody touches. `kind` matters where
// it is `hit`, a ball that flies: along the normal a spring alone, without damper and filter; and `passive`,
// a real thing: the gain is that of all directions. What the rig does not say of its loop is NaN.
[[nodiscard]] ArmLoopAt loop_at(const Impedance& law, const certificate::Hand& hand, double dt,
                                const PerJoint& q, const Vec<'R'>& way, double stiffness, Interaction kind);

// K_v of eq. 2 with the ratio that it has at home, N s/m: back towards its base the tip is felt to be twice
// as heavy. `mass`: felt at the tip, kg.
[[nodiscard]] double damping_at(const Impedance& law, double mass);

}  // namespace enc
