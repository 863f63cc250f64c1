// A spring and a damper that a computer renders through a device, along a normal: the exact eigenvalues of
// the sampled loop, and the stiffness from which on it is not stable. At set-up; linear, without friction and
// encoder steps (release.h has them). Where the device moves sideways as well all directions are one loop.
//
//   (m + m_h) x'' + (b + b_h) x' + k_h x = F       the device, and a hand that is rigidly on it
//   F = -(K e_i + B r_i)  from  iT + t_d  until  (i + 1)T + t_d                     held, and t_d late
//   e_i = x(iT),   r_i = (x(iT) - x((i - n)T)) / (n T),  each through y = (a x + y_before) / (1 + a) where
//   the law has a filter [VisHap eq. 3]
#pragma once

#include <complex>
#include <vector>

#include "core/base/frames.h"

namespace enc::certificate {

// Periods that a loop may look back, by delay and ticks: every one is a row of its matrix.
inline constexpr double kMostPeriods = 600.0;

struct Hand {
  double mass = 0.0;       // kg, that moves with the device
  double damping = 0.0;    // N s/m, to the ground as the next
  double stiffness = 0.0;  // N/m
};

// How the tip moves in all directions, where the law holds it sideways too. x = W eta is its place along the
// normal and along two directions across it, of a device with the mass matrix M and the Jacobian J:
//   eta'' = -C eta' + W^T F,   W W^T = J M^-1 J^T
struct Directions {
  int count = 0;                // of eta; 0: the tip moves along the normal alone
  Mat3 moves = Mat3::Zero();    // W, 1/sqrt(kg): columns from `count` on are 0, as rows and columns of C are
  Mat3 damping = Mat3::Zero();  // C, 1/s
  double stiffness = 0.0;       // N/m, of the law sideways, as the next two
  double damper = 0.0;          // N s/m
  double filter = kUnset;       // a of eq. 3; unset: no filter
  bool alike = false;           // sideways the law has the stiffness and the damper of the normal instead
  [[nodiscard]] bool known() const;
};

struct SampledLoop {
  double mass = kUnset;     // kg, m, above none
  double damping = kUnset;  // N s/m, b, viscous
  double period = kUnset;   // s, T
  double delay = 0.0;       // s, t_d, any: from the reading to the force
  int ticks = 1;            // n: the rate is a difference over so many periods
  double filter = kUnset;   // a of eq. 3, discrete; unset: no filter
  Hand hand{};              // along the normal
  Directions around{};      // with them mass and damping are those of the tip that nothing holds sideways
  // Whether everything that the loop needs is a number that can be: else there is no answer. Delay and ticks
  // are no more than kMostPeriods.
  [[nodiscard]] bool known() const;
  [[nodiscard]] SampledLoop alone() const;  // without the hand
  [[nodiscard]] SampledLoop along() const;  // along the normal alone, as if nothing were sideways
};

// B = fixed + ratio K. A gain lambda on the law of eq. 2 scales both: there only the ratio is not zero.
struct Damper {
  double fixed = 0.0;  // N s/m
  double ratio = 0.0;  // s
  [[nodiscard]] double at(double stiffness) const { return fixed + ratio * stiffness; }
};

// t_d in whole periods and a part of one, 0 <= part < 1.
struct Late {
  int whole = 0;
  double part = 0.0;
};
[[nodiscard]] Late late(const SampledLoop& loop);

// 1 - e^{-j angle}, precise where the angle is small.
[[nodiscard]] std::complex<double> one_less(double angle);
// Of the law at z = e^{j angle}, without its delay: (1 - z^-n) / (nT), and what eq. 3 with the gain a makes
// of either.
[[nodiscard]] std::complex<double> rate_response(const SampledLoop& loop, double angle);
[[nodiscard]] std::complex<double> filter_response(double gain, double angle);
// Angles in (0, pi], close enough for the delay and the ticks of the loop: logarithmic, then even, so many
// more for a period of either.
[[nodiscard]] std::vector<double> angles(const SampledLoop& loop, int for_each_period = 60);

// All eigenvalues of the step from one reading to the next: of place, speed, the readings and forces that are
// remembered. The delay costs: a matrix of t_d / T more rows. Empty where something is not known.
[[nodiscard]] std::vector<std::complex<double>> eigenvalues(const SampledLoop& loop, double stiffness,
                                                            double damper);
// The one with the largest absolute value, which dies out last; NaN where something is not known.
[[nodiscard]] std::complex<double> slowest(const SampledLoop& loop, double stiffness, double damper);
// That value of it.
[[nodiscard]] double spectral_radius(const SampledLoop& loop, double stiffness, double damper);
// rad/s: how fast that one turns.
[[nodiscard]] double ringing(const SampledLoop& loop, double stiffness, double damper);
// Every disturbance dies out. False where something is not known.
[[nodiscard]] bool stable(const SampledLoop& loop, double stiffness, double damper);

inline constexpr double kStiffest = 1e8;  // N/m: nothing is looked for beyond it

// The stiffnesses up to kStiffest at which an eigenvalue is on the unit circle, and where: ascending. They
// are no guess of a search: at z = e^{j angle} that needs K = -(1 / (P(z) G(z)) + B_fixed R(z)) / (1 + ratio
// R(z)) to be real, so all are found along the angle. `dry`, N/m: one more damper of dry / w, w = angle / T;
// what dry friction f_c is to a swing of amplitude A by its describing function, 4 f_c / (pi A).
struct Edge {
  double stiffness = kUnset;  // N/m
  double angle = kUnset;      // rad
  int leave = 0;              // so many eigenvalues leave the circle as K rises; below 0: they enter it
};
[[nodiscard]] std::vector<Edge> edges(const SampledLoop& loop, const Damper& damper, double dry = 0.0);

// The lowest stiffnesses that are stable, N/m: usually from 0 on. {0, 0} where none is; `high` infinite where
// none up to kStiffest is unstable; NaN where something is not known. Between two edges nothing changes, and
// one look at the eigenvalues tells; from what is stable the next edge is the way out.
struct Range {
  double low = kUnset, high = kUnset;
};
[[nodiscard]] Range stable_range(const SampledLoop& loop, const Damper& damper);
// The least stiffness above which the loop is not stable: `high` of the range.
[[nodiscard]] double critical_stiffness(const SampledLoop& loop, const Damper& damper = {});

}  // namespace enc::certificate
