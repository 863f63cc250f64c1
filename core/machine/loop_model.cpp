#include "core/machine/loop_model.h"

#include <algorithm>
#include <complex>
#include <numbers>

namespace enc {

double lowest_stable_stiffness(const LoopModel& loop) {
  using Complex = std::complex<double>;
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  const double servo = kTwoPi * loop.servo_hz;
  const double corner = kTwoPi * loop.filter_hz;
  const auto open_loop = [&](double frequency) {
    const Complex s(0.0, kTwoPi * frequency);
    const Complex hand = loop.moved_mass * s * s + loop.hand_damping * s + loop.hand_stiffness;
    const Complex machine = servo * servo / (s * s + 2.0 * loop.servo_damping * servo * s + servo * servo);
    const Complex filter = corner / (s + corner);
    return hand * machine * filter * std::exp(-s * loop.delay);
  };
  double lowest = 0.0;
  // Frequency rises in fine steps; bisection narrows each sign change of the imaginary part.
  constexpr double kStep = 1.002;
  double f = 0.1;
  Complex before = open_loop(f);
  while (f < 500.0) {
    const Complex after = open_loop(f * kStep);
    if (before.imag() * after.imag() < 0.0) {
      double lo = f;
      double hi = f * kStep;
      for (int i = 0; i < 60; ++i) {
        const double mid = 0.5 * (lo + hi);
        (open_loop(mid).imag() * before.imag() > 0.0 ? lo : hi) = mid;
      }
      lowest = std::max(lowest, -open_loop(lo).real());
    }
    before = after;
    f *= kStep;
  }
  return lowest;
}

}  // namespace enc
