#include "core/control/safety/certificate/bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace enc::certificate {
namespace {

using Complex = std::complex<double>;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Condition on b at one angle: b^2 - b q - w |H|^2 >= 0. H = h0 + h1 K and q = q0 + q1 K are linear in K.
struct Demand {
  Complex h0, h1;
  double q0 = 0.0, q1 = 0.0, w = 0.0;
};
Demand demand_at(const SampledLoop& loop, const Damper& damper, double angle) {
  const LoopDelay delay = late(loop);
  const Complex step = one_less(angle), rate = rate_response(loop, angle);
  const Complex seen = filter_response(loop.filter, angle) * (1.0 - one_less(angle * delay.whole));
  const Complex weight = (1.0 - delay.part * step) * step * (0.5 * loop.period / step.real());  // 1 - cos
  Demand found{damper.fixed * rate * seen, (1.0 + damper.ratio * rate) * seen, 0.0, 0.0,
               0.25 * delay.part * (1.0 - delay.part) * loop.period * loop.period};
  found.q0 = (weight * found.h0).real();
  found.q1 = (weight * found.h1).real();
  return found;
}

// The largest K >= 0 with c + l K - s K^2 >= 0, for s >= 0; 0 if K = 0 already violates it.
double largest_root(double c, double l, double s) {
  if (c < 0.0) return 0.0;
  const double root = std::sqrt(l * l + 4.0 * s * c);
  if (l < 0.0) return 2.0 * c / (root - l);
  return s > 0.0 ? (l + root) / (2.0 * s) : kInfinite;
}

// 2 x / y; infinite if y is 0.
double twice_over(double x, double y) { return y == 0.0 && x >= 0.0 ? kInfinite : 2.0 * x / y; }

bool sane(double value) { return std::isfinite(value) && value >= 0.0; }

bool plain(const SampledLoop& loop, const Damper& damper) {
  return loop.delay == 0.0 && std::isnan(loop.filter) && damper.fixed == 0.0 && damper.ratio == 0.0;
}

// True if dry friction stops an oscillation of that amplitude. `turning`: first estimate of its frequency,
// rad/s. The added damper changes that frequency, so the search repeats.
bool stops(SampledLoop loop, double friction, double stiffness, double damper, double amplitude,
           double turning) {
  constexpr double kSame = 0.02;
  const double viscous = loop.damping, dry = 4.0 * friction / (std::numbers::pi * amplitude);
  for (int i = 0; i < 4 && turning > 0.0; ++i) {
    loop.damping = viscous + dry / turning;
    const Complex z = slowest(loop, stiffness, damper);
    const double rings = std::abs(std::arg(z)) / loop.period;
    if (i == 3 || friction == 0.0 || rings == 0.0 || std::abs(rings - turning) < kSame * turning)
      return std::norm(z) < 1.0;
    turning = rings;
  }
  return false;
}

}  // namespace

bool holds_counts(const SampledLoop& loop, const Steps& steps, double stiffness, double damper) {
  const double pushes = stiffness + 2.0 * std::abs(damper) / (loop.ticks * loop.period);
  return pushes * steps.encoder <= 2.0 * steps.friction;
}

double needed_damping(const SampledLoop& loop, double stiffness, double damper) {
  if (!loop.known() || !std::isfinite(stiffness) || !std::isfinite(damper)) return kUnset;
  double most = 0.0;
  for (const double angle : angles(loop)) {
    const Demand at = demand_at(loop, {damper, 0.0}, angle);
    const double q = at.q0 + at.q1 * stiffness;
    most = std::max(most, 0.5 * q + std::sqrt(0.25 * q * q + at.w * std::norm(at.h0 + at.h1 * stiffness)));
  }
  return most;
}

double passive_stiffness(const SampledLoop& loop, const Damper& damper) {
  if (!loop.known() || !std::isfinite(damper.fixed) || !std::isfinite(damper.ratio)) return kUnset;
  const double b = loop.damping;
  double least = kInfinite;
  for (const double angle : angles(loop)) {
    const Demand at = demand_at(loop, damper, angle);
    const double cross = (at.h0 * std::conj(at.h1)).real();
    // If the force does not change between readings, the condition is divided by b, so that it holds for b =
    // 0 too.
    least =
        std::min(least, at.w > 0.0 ? largest_root(b * b - b * at.q0 - at.w * std::norm(at.h0),
                                                  -b * at.q1 - 2.0 * at.w * cross, at.w * std::norm(at.h1))
                                   : largest_root(b - at.q0, -at.q1, 0.0));
  }
  return least < kStiffest ? least : kInfinite;
}

double quantised_stiffness(const SampledLoop& loop, const Steps& steps) {
  if (!loop.alone().known() || !sane(steps.friction) || !sane(steps.encoder)) return kUnset;
  return std::min(2.0 * loop.damping / loop.period, twice_over(steps.friction, steps.encoder));
}

double delayed_stiffness(const SampledLoop& loop, const Damper& damper) {
  if (!loop.alone().known()) return kUnset;
  const double lag = 0.5 * loop.period + loop.delay - damper.ratio;
  const double damping = loop.damping + damper.fixed;
  if (damping < 0.0) return 0.0;
  return lag > 0.0 ? damping / lag : kInfinite;
}

Plane plane_of(const SampledLoop& loop, const Steps& steps, const Request& asked) {
  const double stiffness = asked.stiffness;
  if (!loop.alone().known() || !sane(steps.friction) || !sane(steps.encoder) || !(stiffness > 0.0)) return {};
  const double beta = loop.damping / (stiffness * loop.period);
  const double sigma = 0.5 * twice_over(steps.friction, stiffness * steps.encoder);
  if (!plain(loop, asked.damper)) return {beta, sigma, Region::unknown};
  const bool sampling = beta >= 0.5, counting = sigma >= 0.5;
  return {beta, sigma,
          sampling ? (counting ? Region::passive : Region::limit_cycle)
                   : (counting ? Region::locally_stable : Region::unstable)};
}

bool friction_stops(const SampledLoop& loop, double friction, double stiffness, double damper,
                    double amplitude) {
  return stops(loop, friction, stiffness, damper, amplitude,
               std::sqrt((stiffness + loop.hand.stiffness) / (loop.mass + loop.hand.mass)));
}

double friction_stiffness(const SampledLoop& loop, double friction, const Damper& damper, double amplitude) {
  if (!loop.known() || !sane(friction) || !std::isfinite(damper.fixed) || !std::isfinite(damper.ratio))
    return kUnset;
  const auto ends = edges(loop, damper, 4.0 * friction / (std::numbers::pi * amplitude));
  if (ends.empty()) return friction_stops(loop, friction, 1.0, damper.at(1.0), amplitude) ? kInfinite : 0.0;
  // The loop still oscillates at the lowest edge's frequency just below that edge.
  const Edge& end = ends.front();
  const double below = 0.99 * end.stiffness, turning = end.angle / loop.period;
  return stops(loop, friction, below, damper.at(below), amplitude, turning) ? end.stiffness : 0.0;
}

std::vector<Row> bounds(const SampledLoop& given, const Steps& steps, const Request& asked) {
  const SampledLoop loop = given.alone().along();
  const Damper& damper = asked.damper;
  const double stiffness = asked.stiffness;
  std::vector<Row> rows;
  const auto add = [&](const char* name, const char* formula, const Range& range, bool applies,
                       const char* source) {
    const double margin = stiffness < range.low ? stiffness / range.low : range.high / stiffness;
    rows.push_back({name, formula, range.high, margin, applies, source, range.low});
  };
  const bool one_way = given.around.count == 0;  // the formulas assume motion along the normal only
  const bool spring = one_way && plain(loop, damper);
  const bool held = one_way && holds_counts(loop, steps, stiffness, damper.at(stiffness));
  const double quantised = quantised_stiffness(loop, steps);
  add("colgate_schenkel", "b > T/2 1/(1 - cos wT) Re{(1 - e^{-jwT}) H(e^{jwT})}, 0 < w <= pi/T",
      {0.0, passive_stiffness(loop, damper)}, one_way, "Colgate and Schenkel 1997");
  add("abbott_okamura", "K <= min(2 b/T, 2 f_c/step)", {0.0, quantised}, spring, "Abbott and Okamura 2005");
  add("gil_hulin", "K < (b + B)/(T/2 + t_d)", {0.0, delayed_stiffness(loop, damper)},
      one_way && std::isnan(loop.filter) && loop.ticks == 1 && damper.at(stiffness) <= loop.damping &&
          loop.damping * (2.0 * loop.period + loop.delay) <= kShort * loop.mass,
      "Gil et al. 2004, Hulin et al. 2006");
  add("diolaiti", "b/(K T) >= 1/2 or f_c/(K step) >= 1/2",
      {0.0, std::isnan(quantised)
                ? kUnset
                : std::max(2.0 * loop.damping / loop.period, twice_over(steps.friction, steps.encoder))},
      spring, "Diolaiti et al. 2006");
  add("friction_small", "|z| < 1 with 4 f_c/(pi w 0.1 mm) more damping",
      {0.0, friction_stiffness(loop, steps.friction, damper, kSmall)}, held, "describing function");
  add("friction_large", "|z| < 1 with 4 f_c/(pi w 1 mm) more damping",
      {0.0, friction_stiffness(loop, steps.friction, damper, kLarge)}, held, "describing function");
  add("exact_alone", "|z| < 1 of the sampled loop", stable_range(given.alone(), damper), true, "eigenvalues");
  add("exact_with_hand", "|z| < 1 of the sampled loop and the hand", stable_range(given, damper), true,
      "eigenvalues");
  return rows;
}

}  // namespace enc::certificate
