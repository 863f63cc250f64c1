// A spring and a damper that a computer renders through a device along a normal: the exact eigenvalues of the
// sampled loop and its critical stiffness. Used at set-up; linear, without friction and encoder steps
// (release() has them). If the device moves sideways too, all directions form one loop.
//
//   (m + m_h) x'' + (b + b_h) x' + k_h x = F       device with a rigidly attached hand
//   F = -(K e_i + B r_i)  from  iT + t_d  until  (i + 1)T + t_d                     held, and t_d late
//   e_i = x(iT),   r_i = (x(iT) - x((i - n)T)) / (n T)
// A law with a filter applies y = (a x + y_before) / (1 + a) to e and to r [VisHap eq. 3].
#pragma once

#include <complex>
#include <vector>

#include "core/base/frames.h"

namespace enc::certificate {

// Most periods that a loop may look back, by delay and ticks: each is a row of its matrix.
inline constexpr double kMostPeriods = 600.0;

struct Hand {
  double mass = 0.0;       // kg, moving with the device
  double damping = 0.0;    // N s/m, to the ground
  double stiffness = 0.0;  // N/m, to the ground
};

// Motion of the tip in all directions, for a law that acts sideways too. x = W eta is its position along the
// normal and two directions across it; the device has the mass matrix M and the Jacobian J:
//   eta'' = -C eta' + W^T F,   W W^T = J M^-1 J^T
struct Directions {
  int count = 0;                // size of eta; 0: motion along the normal only
  Mat3 moves = Mat3::Zero();    // W, 1/sqrt(kg); from column `count` on 0, as is C
  Mat3 damping = Mat3::Zero();  // C, 1/s
  double stiffness = 0.0;       // sideways stiffness of the law, N/m
  double damper = 0.0;          // sideways damper of the law, N s/m
  double filter = kUnset;       // sideways filter: a of eq. 3; unset: no filter
  bool alike = false;           // sideways, the law acts as along the normal
  [[nodiscard]] bool known() const;
};

struct SampledLoop {
  double mass = kUnset;     // m, kg, above 0
  double damping = kUnset;  // b, viscous, N s/m
  double period = kUnset;   // T, s
  double delay = 0.0;       // t_d, s, any value: from the reading to the force
  int ticks = 1;            // n: the rate is a difference over n periods
  double filter = kUnset;   // a of eq. 3, discrete; unset: no filter
  Hand hand{};              // acts along the normal
  Directions around{};      // if set, mass and damping are those of the sideways-free tip
  // True if every required figure is a possible number; otherwise there is no answer. Delay and ticks may be
  // at most kMostPeriods.
  [[nodiscard]] bool known() const;
  [[nodiscard]] SampledLoop alone() const;  // copy without the hand
  [[nodiscard]] SampledLoop along() const;  // copy with motion along the normal only
};

// B = fixed + ratio K. A gain lambda on the law of eq. 2 scales both: then only the ratio is not zero.
struct Damper {
  double fixed = 0.0;  // N s/m
  double ratio = 0.0;  // s
  [[nodiscard]] double at(double stiffness) const { return fixed + ratio * stiffness; }
};

// t_d as whole periods and a fraction of one, 0 <= part < 1.
struct LoopDelay {
  int whole = 0;
  double part = 0.0;
};
[[nodiscard]] LoopDelay late(const SampledLoop& loop);

// 1 - e^{-j angle}, precise for small angles.
[[nodiscard]] std::complex<double> one_less(double angle);
// Responses of the law at z = e^{j angle}, without its delay: the rate (1 - z^-n) / (nT), and the filter of
// eq. 3 with the gain a.
[[nodiscard]] std::complex<double> rate_response(const SampledLoop& loop, double angle);
[[nodiscard]] std::complex<double> filter_response(double gain, double angle);
// Angles in (0, pi], dense enough for the delay and the ticks of the loop: logarithmic, then even, with
// `for_each_period` angles for each period of either.
[[nodiscard]] std::vector<double> angles(const SampledLoop& loop, int for_each_period = 60);

// All eigenvalues of the step from one reading to the next: position, speed, remembered readings and forces.
// The delay adds t_d / T rows to the matrix. Empty if a figure is unknown.
[[nodiscard]] std::vector<std::complex<double>> eigenvalues(const SampledLoop& loop, double stiffness,
                                                            double damper);
// The eigenvalue with the largest absolute value, which dies out last; NaN if a figure is unknown.
[[nodiscard]] std::complex<double> slowest(const SampledLoop& loop, double stiffness, double damper);
// Absolute value of the slowest eigenvalue.
[[nodiscard]] double spectral_radius(const SampledLoop& loop, double stiffness, double damper);
// rad/s: angular frequency of the slowest eigenvalue.
[[nodiscard]] double ringing(const SampledLoop& loop, double stiffness, double damper);
// True if every disturbance dies out. False if a figure is unknown.
[[nodiscard]] bool stable(const SampledLoop& loop, double stiffness, double damper);

inline constexpr double kStiffest = 1e8;  // N/m: upper end of every search

// Stiffnesses up to kStiffest at which an eigenvalue lies on the unit circle, with its angle, ascending. The
// search misses no edge: at z = e^{j angle}, K = -(1 / (P(z) G(z)) + B_fixed R(z)) / (1 + ratio R(z)) must be
// real, so a scan of the angle finds them all. `dry`, N/m, adds a damper of dry / w, w = angle / T: dry
// friction f_c at amplitude A is 4 f_c / (pi A) by its describing function.
struct Edge {
  double stiffness = kUnset;  // N/m
  double angle = kUnset;      // rad
  int leave = 0;              // number of eigenvalues that leave the circle as K rises; < 0: enter
};
[[nodiscard]] std::vector<Edge> edges(const SampledLoop& loop, const Damper& damper, double dry = 0.0);

// The lowest range of stable stiffnesses, N/m, usually from 0 on. {0, 0} if no stiffness is stable; `high` is
// infinite if none up to kStiffest is unstable; NaN if a figure is unknown. Stability changes only at an
// edge: one look at the eigenvalues decides between two edges, and from a stable stiffness the next edge is
// the way out.
struct Range {
  double low = kUnset, high = kUnset;
};
[[nodiscard]] Range stable_range(const SampledLoop& loop, const Damper& damper);
// The stiffness above which the loop becomes unstable: `high` of the range.
[[nodiscard]] double critical_stiffness(const SampledLoop& loop, const Damper& damper = {});

}  // namespace enc::certificate
