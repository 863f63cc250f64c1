// What stiffness a device can render, by the formulas of the literature and by the exact eigenvalues, each as
// a row that is printed. The formulas judge the normal alone, the eigenvalues all directions
// (sampled_loop.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/words.h"
#include "core/control/safety/certificate/sampled_loop.h"

namespace enc::certificate {

// What makes the loop another one for small motions than for large ones.
struct Steps {
  double friction = kUnset;  // N, f_c, dry
  double encoder = kUnset;   // m, one count; 0: without steps
};

// What is asked for.
struct Asked {
  double stiffness = kUnset;  // N/m, K
  Damper damper{};
};

struct Row {
  std::string name;
  std::string formula;
  double bound = kUnset;   // N/m; infinite: none; NaN: not known
  double margin = kUnset;  // bound over what is asked for: 1 and more holds. Below `low`: that over `low`
  bool applies = true;     // what the formula was derived for is so; else the row is there to compare
  std::string source;
  double low = 0.0;  // N/m: what holds begins here
  // Or somewhere below or above it, and no more is known; the margin likewise.
  enum class Side : std::uint8_t { at, below, above } side = Side::at;
};
constexpr auto words(Row::Side) { return enum_words("at", "below", "above"); }
// Before the number that a row names.
[[nodiscard]] constexpr const char* sign_of(Row::Side side) {
  return side == Row::Side::below ? "< " : side == Row::Side::above ? "> " : "";
}

// N s/m: the least b with which the device is passive, for whatever hand [Colgate and Schenkel 1997]:
//   b > T/2 1/(1 - cos wT) Re{(1 - e^{-jwT}) H(e^{jwT})},  0 < w <= pi/T;  H = (K + B (1 - z^-n)/(nT)) G z^-d
// A delay of a part p of a period has the force change between two readings. Then, of the same proof with the
// way between them free (docs/reference/stability.md):
//   b >= q/2 + sqrt(q^2/4 + p (1 - p) T^2 |H|^2 / 4),  q: that right side with Re{(1 - p + p z^-1)(1 - z^-1)
//   H}
[[nodiscard]] double needed_damping(const SampledLoop& loop, double stiffness, double damper);
// Whether friction takes what a count gives out: (K + 2 |B|/(nT)) step <= 2 f_c. The rate steps by step/(nT),
// up and down again.
[[nodiscard]] bool holds_counts(const SampledLoop& loop, const Steps& steps, double stiffness, double damper);
// N/m: the largest that is passive so, with all below it; 0: none; infinite: all up to kStiffest.
[[nodiscard]] double passive_stiffness(const SampledLoop& loop, const Damper& damper);

// min(2b/T, 2 f_c/step) [Abbott and Okamura 2005]: a spring without delay and damper.
[[nodiscard]] double quantised_stiffness(const SampledLoop& loop, const Steps& steps);
// (b + B) / (T/2 + t_d) [Gil et al. 2004; Hulin et al. 2006]: for B not above b, and delays that are short
// for the device, b (2 T + t_d)/m <= kShort. There it is within 5 % of the boundary
// (docs/reference/stability.md).
inline constexpr double kShort = 0.1;
[[nodiscard]] double delayed_stiffness(const SampledLoop& loop, const Damper& damper);

// beta = b/(K T), sigma = f_c/(K step) [Diolaiti et al. 2006]: by sampling and by encoder steps a spring
// gives out more than viscous damping and friction take, from 1/2 down. A spring without delay, damper and
// filter: of another loop the region is `unknown`.
enum class Region : std::uint8_t { passive, limit_cycle, locally_stable, unstable, unknown };
constexpr auto words(Region) {
  return enum_words("passive", "limit cycle", "locally stable", "globally unstable", "unknown");
}
struct Plane {
  double beta = kUnset, sigma = kUnset;
  Region region = Region::unknown;
};
[[nodiscard]] Plane plane_of(const SampledLoop& loop, const Steps& steps, const Asked& asked);

// Whether dry friction brings a swing of that amplitude, m, to rest: by its describing function it is one
// more damper of 4 f_c / (pi w amplitude), w what the loop rings with. Sinusoidal; no encoder steps.
[[nodiscard]] bool friction_stops(const SampledLoop& loop, double friction, double stiffness, double damper,
                                  double amplitude);
// N/m: the largest that it stops, with all below it: the lowest of the edges with that damper
// (sampled_loop.h).
[[nodiscard]] double friction_stiffness(const SampledLoop& loop, double friction, const Damper& damper,
                                        double amplitude);

inline constexpr double kSmall = 1e-4, kLarge = 1e-3;  // m: the two disturbances that are judged

// All of them: colgate_schenkel, abbott_okamura, gil_hulin, diolaiti, friction_small, friction_large,
// exact_alone, exact_with_hand. `loop.hand` is the hand that may be on it: all but the last are without it.
// If the tip moves sideways too, only the exact rows apply.
[[nodiscard]] std::vector<Row> bounds(const SampledLoop& loop, const Steps& steps, const Asked& asked);

}  // namespace enc::certificate
