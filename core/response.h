// How an object pushes back along its normal: press and release polynomials of 4th order [VHMR 4.2],
// continuous and passive between the two, and the inverse that an admittance device needs.
#pragma once

#include <array>

namespace enc {

// As measured: coefficients of d^1..d^4, ascending, N/m^k. Zero force at zero deflection by construction.
struct ResponseSpec {
  std::array<double, 4> press{};
  std::array<double, 4> release{};
  double limit = 0.0;  // deflection, m, up to which the polynomials are meant
};

// Where the object is on its loop. alpha: 0 on the release curve, 1 on the press curve.
struct ResponseState {
  double deflection = 0.0;  // m
  double alpha = 1.0;
};

// F(d) = F_release(d) + alpha * gap(d), gap = F_press - F_release >= 0. alpha follows the travel: with Y(d)
// the integral of gap, d alpha = dY / L, clipped to [0, 1] (an elastic-plastic stop with storage L alpha^2 /
// 2). So the force is continuous, and no closed path of deflection that starts at rest yields energy. At zero
// deflection the object recovers: alpha = 1; that costs nothing, because gap and Y are zero there
// (docs/model.md). L = largest gap * kBlend.
class Response {
 public:
  static constexpr double kBlend = 0.4e-3;  // m; fidelity 3: reversal without a jump at hand speeds

  Response() = default;  // none: of a real object, which is not rendered
  // Throws Error naming the interval where a curve is not monotone, falls below `lowest_slope` (N/m, what the
  // admittance loop renders stably), or where release exceeds press.
  Response(const ResponseSpec& spec, double lowest_slope);

  [[nodiscard]] double limit() const { return limit_; }
  [[nodiscard]] double press(double deflection) const noexcept;    // N
  [[nodiscard]] double release(double deflection) const noexcept;  // N
  [[nodiscard]] double largest_gap() const { return largest_gap_; }
  // Moves the state to a deflection in [0, limit] and gives the force there, N.
  double force(ResponseState& state, double deflection) const noexcept;
  // Moves the state to the deflection at which the object pushes back with `force`, and gives it. Clamped to
  // [0, most], most <= limit.
  double deflection(ResponseState& state, double force, double most) const noexcept;
  double deflection(ResponseState& state, double force) const noexcept {
    return deflection(state, force, limit_);
  }

 private:
  [[nodiscard]] double gap_integral(double u) const noexcept;  // Y, N m
  [[nodiscard]] double alpha_at(const ResponseState& from, double u) const noexcept;

  // Over u = deflection / limit, so that the coefficients are in N and of like size.
  std::array<double, 4> press_{}, release_{};
  double limit_ = 0.0, largest_gap_ = 0.0, stop_ = 0.0;
};

}  // namespace enc
