// The force of an object along its normal, and the inverse that an admittance device needs. Two models cover
// the range between pressing and releasing; the scene selects one (behaviour key `reversal`).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/words.h"

namespace enc {

inline constexpr std::size_t kMaxStops = 16, kMaxCurve = 8;

// A Prandtl-Ishlinskii operator: an elastic curve in parallel with stops (spring and slider in series).
struct StopsSpec {
  std::vector<double> curve;    // N: coefficients of (d / limit)^1, ^2, ..., at most kMaxCurve
  std::vector<double> radii;    // m: travel at which a stop begins to slide
  std::vector<double> weights;  // N/m, >= 0: stiffness of a stop at the deflection limit
};

// Measured curves: coefficients of d^1..d^4, ascending, N/m^k. Zero force at zero deflection by construction.
struct ResponseSpec {
  std::array<double, 4> press{};
  std::array<double, 4> release{};
  double limit = 0.0;  // deflection up to which the curves are valid, m
  std::optional<StopsSpec> stops = std::nullopt;
};

enum class Reversal : std::uint8_t {
  energy_stop,        // the two polynomials of [VHMR 4.2], with a passive blend
  prandtl_ishlinskii  // ResponseSpec::stops: more accurate if the direction changes within a press
};
constexpr auto words(Reversal) { return enum_words("energy_stop", "prandtl_ishlinskii"); }

// State of the object on its loop. alpha belongs to the energy stop: 0 on the release curve, 1 on the press
// curve. stop belongs to Prandtl-Ishlinskii: stretch of each stop, m.
struct ResponseState {
  double deflection = 0.0;  // m
  double alpha = 1.0;
  std::array<double, kMaxStops> stop{};
};

// F(d) = F_release(d) + alpha * gap(d), gap = F_press - F_release >= 0. alpha follows the travel: with Y(d)
// the integral of gap, d alpha = dY / L, clipped to [0, 1] (an elastic-plastic stop with storage L alpha^2 /
// 2). So the force is continuous, and no closed path of deflection that starts at rest yields energy. At zero
// deflection alpha is 1 again, which costs no energy: gap and Y are zero there. L = largest gap * kBlend.
class EnergyStop {
 public:
  // m. While alpha moves, the object is stiffer by gap^2 / L <= largest gap / kBlend. A tremor of
  // +-30 um at rest must not change the force by more than 0.2 N (sources/ball 6).
  static constexpr double kBlend = 1.5e-3;

  EnergyStop() = default;  // no force
  EnergyStop(const ResponseSpec& spec, double lowest_slope);
  [[nodiscard]] double press(double u) const noexcept;
  [[nodiscard]] double release(double u) const noexcept;
  [[nodiscard]] double force(const ResponseState& from, double u) const noexcept;
  void move(ResponseState& state, double u) const noexcept;

 private:
  [[nodiscard]] double gap_integral(double u) const noexcept;  // Y, N m
  [[nodiscard]] double alpha_at(const ResponseState& from, double u) const noexcept;

  std::array<double, 4> press_{}, release_{};  // functions of u = deflection / limit, N
  double limit_ = 0.0, stop_ = 0.0;
};

// F(d) = curve(d) + (d / limit) * sum of w_i x_i. x_i, the stretch of stop i, follows the deflection one to
// one and slides at +-r_i. The friction grows with depth, as Coulomb friction does with the normal force. The
// law is passive. Let o_i = d - x_i be the deflection at which stop i would be at rest. The storage is the
// integral of the curve plus w_i times the integral of (z / limit) (z - o_i) over z from o_i to d. Each term
// is >= 0, and sliding only takes from it. At zero deflection the object recovers: x_i = 0, which discards
// the rest of the storage.
class PrandtlIshlinskii {
 public:
  PrandtlIshlinskii(const ResponseSpec& spec, double lowest_slope);
  [[nodiscard]] double press(double u) const noexcept;    // first press from rest
  [[nodiscard]] double release(double u) const noexcept;  // after a press to the limit
  [[nodiscard]] double force(const ResponseState& from, double u) const noexcept;
  void move(ResponseState& state, double u) const noexcept;

 private:
  [[nodiscard]] double curve(double u) const noexcept;

  std::array<double, kMaxCurve> curve_{};              // N, over u
  std::array<double, kMaxStops> radius_{}, weight_{};  // m, N/m; only stops with a weight
  std::size_t stops_ = 0;
  double limit_ = 0.0;
};

class Response {
 public:
  Response() = default;  // no response: a real object, which is not rendered
  // Throws Error with the interval in which a force does not rise, rises less than `lowest_slope` (N/m,
  // stable limit of the loop) or is higher on release than on press; also if the chosen model lacks data.
  Response(const ResponseSpec& spec, double lowest_slope, Reversal reversal = Reversal::energy_stop);

  [[nodiscard]] double limit() const { return limit_; }
  // Force while pressing from rest and while releasing from the limit, N.
  [[nodiscard]] double press(double deflection) const noexcept;
  [[nodiscard]] double release(double deflection) const noexcept;
  [[nodiscard]] double largest_gap() const { return largest_gap_; }
  // Moves the state to a deflection in [0, limit] and returns the force there, N.
  double force(ResponseState& state, double deflection) const noexcept;
  // Moves the state to the deflection at which the object pushes back with `force`, and returns it. Clamped
  // to [0, most], most <= limit.
  double deflection(ResponseState& state, double force, double most) const noexcept;
  double deflection(ResponseState& state, double force) const noexcept {
    return deflection(state, force, limit_);
  }

 private:
  std::variant<EnergyStop, PrandtlIshlinskii> law_;
  double limit_ = 0.0, largest_gap_ = 0.0;
};

}  // namespace enc
