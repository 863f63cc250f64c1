// The largest stiffness that a device can render, by the formulas of the literature and by the exact
// eigenvalues; each bound is a row to print. The formulas judge only the normal, the eigenvalues judge all
// directions (sampled_loop.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/words.h"
#include "core/control/safety/certificate/sampled_loop.h"

namespace enc::certificate {

// Nonlinear parts of the loop, which make small motions differ from large ones.
struct Steps {
  double friction = kUnset;  // f_c, dry friction, N
  double encoder = kUnset;   // one encoder count, m; 0: no quantisation
};

// The requested rendering.
struct Request {
  double stiffness = kUnset;  // K, N/m
  Damper damper{};
};

struct Row {
  std::string name;
  std::string formula;
  double bound = kUnset;  // N/m; infinite: no bound; NaN: unknown
  // Bound over the requested value; 1 or more: the request is within the bound. Below `low`: the requested
  // value over `low`.
  double margin = kUnset;
  // True if the formula's assumptions hold; otherwise the row is there only to compare.
  bool applies = true;
  std::string source;
  double low = 0.0;  // N/m: lower end of the range within the bound
  // The bound is this value, or is only known to be below or above it. The same applies to the margin.
  enum class Side : std::uint8_t { at, below, above } side = Side::at;
};
constexpr auto words(Row::Side) { return enum_words("at", "below", "above"); }
// Sign to print in front of the row's number.
[[nodiscard]] constexpr const char* sign_of(Row::Side side) {
  return side == Row::Side::below ? "< " : side == Row::Side::above ? "> " : "";
}

// Least b with which the device is passive for every hand, N s/m [Colgate and Schenkel 1997]:
//   b > T/2 1/(1 - cos wT) Re{(1 - e^{-jwT}) H(e^{jwT})},  0 < w <= pi/T;  H = (K + B (1 - z^-n)/(nT)) G z^-d
// A delay with a fraction p of a period changes the force between two readings. The same proof, with the
// motion between the readings free, then gives (docs/reference/stability.md):
//   b >= q/2 + sqrt(q^2/4 + p (1 - p) T^2 |H|^2 / 4),  q: that right side with Re{(1 - p + p z^-1)(1 - z^-1)
//   H}
[[nodiscard]] double needed_damping(const SampledLoop& loop, double stiffness, double damper);
// True if friction dissipates the energy that one encoder count injects: (K + 2 |B|/(nT)) step <= 2 f_c. The
// estimated rate jumps up by step/(nT) and down again.
[[nodiscard]] bool holds_counts(const SampledLoop& loop, const Steps& steps, double stiffness, double damper);
// Largest stiffness below which every stiffness is passive by these conditions, N/m. 0: no stiffness;
// infinite: all up to kStiffest.
[[nodiscard]] double passive_stiffness(const SampledLoop& loop, const Damper& damper);

// min(2b/T, 2 f_c/step) [Abbott and Okamura 2005]; valid for a spring without delay and damper.
[[nodiscard]] double quantised_stiffness(const SampledLoop& loop, const Steps& steps);
// (b + B) / (T/2 + t_d) [Gil et al. 2004; Hulin et al. 2006]. It is valid for B <= b and delays that are
// short for the device, b (2 T + t_d)/m <= kShort. It is then within 5 % of the boundary
// (docs/reference/stability.md).
inline constexpr double kShort = 0.1;
[[nodiscard]] double delayed_stiffness(const SampledLoop& loop, const Damper& damper);

// beta = b/(K T), sigma = f_c/(K step) [Diolaiti et al. 2006]. Below 1/2, sampling (beta) and encoder steps
// (sigma) make a spring inject more energy than viscous damping and friction dissipate. The plane is valid
// for a spring without delay, damper and filter; any other loop has the region `unknown`.
enum class Region : std::uint8_t { passive, limit_cycle, locally_stable, unstable, unknown };
constexpr auto words(Region) {
  return enum_words("passive", "limit cycle", "locally stable", "globally unstable", "unknown");
}
struct Plane {
  double beta = kUnset, sigma = kUnset;
  Region region = Region::unknown;
};
[[nodiscard]] Plane plane_of(const SampledLoop& loop, const Steps& steps, const Request& asked);

// True if dry friction stops an oscillation of that amplitude (m). By its describing function, friction is
// one more damper of 4 f_c / (pi w amplitude). w is the frequency at which the loop rings. Assumes sinusoidal
// motion without encoder steps.
[[nodiscard]] bool friction_stops(const SampledLoop& loop, double friction, double stiffness, double damper,
                                  double amplitude);
// Largest stiffness below which friction stops every oscillation of that amplitude, N/m: the lowest of the
// edges with that damper (sampled_loop.h).
[[nodiscard]] double friction_stiffness(const SampledLoop& loop, double friction, const Damper& damper,
                                        double amplitude);

inline constexpr double kSmall = 1e-4, kLarge = 1e-3;  // m: the two disturbances that the certificate judges

// All rows: colgate_schenkel, abbott_okamura, gil_hulin, diolaiti, friction_small, friction_large,
// exact_alone, exact_with_hand. Only the last row includes `loop.hand`. If the tip moves sideways too, only
// the exact rows apply.
[[nodiscard]] std::vector<Row> bounds(const SampledLoop& loop, const Steps& steps, const Request& asked);

}  // namespace enc::certificate
