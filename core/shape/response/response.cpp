#include "core/shape/response/response.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "core/base/error.h"

namespace enc {
namespace {

// ---- Conditions on a response for an admittance: it grows with deflection, and everywhere at least as fast
// as the loop can render.

// The first interval of [0, 1] with f < 0. The steps are so fine that no relevant dip hides between them.
struct Interval {
  double from = 0.0, to = 0.0;
  bool found = false;
};
template <class F>
Interval first_below_zero(const F& f) {
  constexpr int kSteps = 2000;
  Interval bad;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = static_cast<double>(i) / kSteps;
    if (f(u) < 0.0) {
      if (!bad.found) bad.from = u;
      bad.found = true;
      bad.to = u;
    } else if (bad.found) {
      break;
    }
  }
  return bad;
}

// A number with three decimals, or six digits for large numbers, independent of the locale.
std::string decimals(double x) {
  constexpr double kLarge = 1e6;
  std::array<char, 32> text{};
  char* const from = text.data();
  char* const to = from + text.size();
  const auto end = std::abs(x) < kLarge ? std::to_chars(from, to, x, std::chars_format::fixed, 3)
                                        : std::to_chars(from, to, x, std::chars_format::general, 6);
  return {from, end.ptr};
}

void refuse(const Interval& bad, double limit, const std::string& curve, const std::string& key,
            const std::string& what) {
  if (bad.found)
    throw Error(curve + " curve " + what + " from " + decimals(bad.from * limit * 1e3) + " to " +
                    decimals(bad.to * limit * 1e3) +
                    " (deflection in millimetres); an admittance needs one deflection for each force",
                key);
}
std::string too_soft(double lowest_slope) {
  return "is softer than the loop renders stably (" + decimals(lowest_slope * 1e-3) + " N per millimetre)";
}

}  // namespace

// ---- The press and release polynomials, and the forces between them [VHMR 3.4].

namespace {

using Coefficients = std::array<double, 4>;

double value(const Coefficients& c, double u) { return u * (c[0] + u * (c[1] + u * (c[2] + u * c[3]))); }
double slope(const Coefficients& c, double u) {
  return c[0] + u * (2 * c[1] + u * (3 * c[2] + u * 4 * c[3]));
}

}  // namespace

EnergyStop::EnergyStop(const ResponseSpec& spec, double lowest_slope) : limit_(spec.limit) {
  double power = 1.0;
  for (std::size_t k = 0; k < 4; ++k) {
    power *= limit_;
    press_[k] = spec.press[k] * power;
    release_[k] = spec.release[k] * power;
    if (!std::isfinite(press_[k]) || !std::isfinite(release_[k]))
      throw Error("coefficients must be finite", "press");
  }
  const double floor = lowest_slope * limit_ * (1.0 - 1e-9);
  const auto check = [&](const char* curve, const std::string& what, const auto& f) {
    refuse(first_below_zero(f), limit_, curve, curve, what);
  };
  check("press", "falls with deflection", [&](double u) { return slope(press_, u); });
  check("release", "falls with deflection", [&](double u) { return slope(release_, u); });
  check("press", too_soft(lowest_slope), [&](double u) { return slope(press_, u) - floor; });
  check("release", too_soft(lowest_slope), [&](double u) { return slope(release_, u) - floor; });
  check("release", "is above the press curve",
        [&](double u) { return value(press_, u) - value(release_, u) + 1e-9; });
  for (int i = 0; i <= 2000; ++i) {
    const double u = i / 2000.0;
    stop_ = std::max(stop_, kBlend * (value(press_, u) - value(release_, u)));
  }
}

double EnergyStop::press(double u) const noexcept { return value(press_, u); }
double EnergyStop::release(double u) const noexcept { return value(release_, u); }

double EnergyStop::gap_integral(double u) const noexcept {
  double y = 0.0;
  for (std::size_t k = 4; k-- > 0;) y = u * (y + (press_[k] - release_[k]) / static_cast<double>(k + 2));
  return y * u * limit_;
}

double EnergyStop::alpha_at(const ResponseState& from, double u) const noexcept {
  if (u <= 0.0 || stop_ <= 0.0) return 1.0;  // recovered, or a curve without a loop
  const double travel = gap_integral(u) - gap_integral(from.deflection / limit_);
  return std::clamp(from.alpha + travel / stop_, 0.0, 1.0);
}

double EnergyStop::force(const ResponseState& from, double u) const noexcept {
  const double released = value(release_, u);
  return released + alpha_at(from, u) * (value(press_, u) - released);
}
void EnergyStop::move(ResponseState& state, double u) const noexcept {
  state.alpha = alpha_at(state, u);
  state.deflection = u * limit_;
}

// ---- Parallel springs that slip: a response with hysteresis that remembers every reversal.

namespace {

void check_sizes(const StopsSpec& s) {
  if (s.curve.empty() || s.curve.size() > kMaxCurve)
    throw Error("the stops' curve has 1 to " + std::to_string(kMaxCurve) + " coefficients", "stops.curve");
  if (s.radii.size() != s.weights.size() || s.radii.size() > kMaxStops)
    throw Error("each stop has a radius and a weight, and there are at most " + std::to_string(kMaxStops),
                "stops.weights");
}

void check_stop(double radius, double weight) {
  if (!(radius > 0.0) || !std::isfinite(radius))
    throw Error("the radius of a stop is a positive length", "stops.radii");
  if (!(weight >= 0.0) || !std::isfinite(weight))
    throw Error("the weight of a stop is 0 or more: a negative one would yield energy", "stops.weights");
}

}  // namespace

PrandtlIshlinskii::PrandtlIshlinskii(const ResponseSpec& spec, double lowest_slope) : limit_(spec.limit) {
  if (!spec.stops)
    throw Error(
        "the response file has no [stops]; expected them for reversal = \"prandtl_ishlinskii\"; write the "
        "file "
        "with `encounter fit`, or set reversal = \"energy_stop\"",
        "reversal");
  const StopsSpec& s = *spec.stops;
  check_sizes(s);
  for (std::size_t k = 0; k < s.curve.size(); ++k) {
    if (!std::isfinite(s.curve[k])) throw Error("coefficients must be finite", "stops.curve");
    curve_[k] = s.curve[k];
  }
  for (std::size_t i = 0; i < s.radii.size(); ++i) {
    check_stop(s.radii[i], s.weights[i]);
    if (s.weights[i] == 0.0) continue;
    radius_[stops_] = s.radii[i];
    weight_[stops_++] = s.weights[i];
  }
  // Whatever the history, a stop at d is stretched no less than after a press to the limit. Its resting place
  // d - x only moves while it slides, so it lies between 0 and limit - r. The least slope occurs there; a
  // stop that does not slide only adds to it.
  const auto least_slope = [&](double u) {
    double rise = 0.0;
    for (std::size_t k = kMaxCurve; k-- > 0;) rise = rise * u + static_cast<double>(k + 1) * curve_[k];
    for (std::size_t i = 0; i < stops_; ++i)
      rise += weight_[i] * std::max(-radius_[i], std::min(radius_[i], limit_) - limit_ * (1.0 - u));
    return rise;
  };
  const double floor = lowest_slope * limit_ * (1.0 - 1e-9);
  const auto check = [&](const std::string& what, double least) {
    refuse(first_below_zero([&](double u) { return least_slope(u) - least; }), limit_, "stops'", "stops",
           what);
  };
  check("falls with deflection", 0.0);
  check(too_soft(lowest_slope), floor);
}

double PrandtlIshlinskii::curve(double u) const noexcept {
  double y = 0.0;
  for (std::size_t k = kMaxCurve; k-- > 0;) y = u * (y + curve_[k]);
  return y;
}

double PrandtlIshlinskii::press(double u) const noexcept { return force(ResponseState{}, u); }
double PrandtlIshlinskii::release(double u) const noexcept {
  ResponseState pressed;
  move(pressed, 1.0);
  return force(pressed, u);
}

double PrandtlIshlinskii::force(const ResponseState& from, double u) const noexcept {
  const double travel = u * limit_ - from.deflection;
  double friction = 0.0;
  for (std::size_t i = 0; i < stops_; ++i)
    friction += weight_[i] * std::clamp(from.stop[i] + travel, -radius_[i], radius_[i]);
  return curve(u) + u * friction;
}
void PrandtlIshlinskii::move(ResponseState& state, double u) const noexcept {
  const double travel = u * limit_ - state.deflection;
  for (std::size_t i = 0; i < stops_; ++i)
    state.stop[i] = u > 0.0 ? std::clamp(state.stop[i] + travel, -radius_[i], radius_[i]) : 0.0;
  state.deflection = u * limit_;
}

namespace {

using Law = std::variant<EnergyStop, PrandtlIshlinskii>;

Law law_of(const ResponseSpec& spec, double lowest_slope, Reversal reversal) {
  if (!(spec.limit > 0.0) || !std::isfinite(spec.limit))
    throw Error("deflection limit must be a positive length", "limit");
  if (reversal == Reversal::prandtl_ishlinskii) return PrandtlIshlinskii(spec, lowest_slope);
  return EnergyStop(spec, lowest_slope);
}

// Calls f with the law in use. Unlike std::visit this cannot throw.
template <class F>
auto with(const Law& law, const F& f) noexcept {
  if (const auto* stops = std::get_if<PrandtlIshlinskii>(&law)) return f(*stops);
  return f(*std::get_if<EnergyStop>(&law));
}

// The u in [0, end] at which rise(u) = wanted. rise is 0 at 0, more than `wanted` at `end`, and rises
// strictly, with kinks where a stop begins to slide: secant steps (Illinois) inside a shrinking bracket.
template <class F>
double crossing(const F& rise, double wanted, double end, double guess) noexcept {
  double lo = 0.0;
  double hi = end;
  double f_lo = -wanted;
  double f_hi = rise(end) - wanted;
  double u = std::clamp(guess, 0.0, end);
  for (int i = 0; i < 60; ++i) {
    const double f = rise(u) - wanted;
    if (f > 0.0) {
      hi = u;
      f_hi = f;
    } else {
      lo = u;
      f_lo = f;
    }
    if (std::abs(f) < 1e-12 || hi - lo < 1e-14) break;
    const double secant = (lo * f_hi - hi * f_lo) / (f_hi - f_lo);
    // Alternate with bisection, so that a bracket end that does not move cannot stall the search.
    u = (i % 3 == 2 || !(secant > lo && secant < hi)) ? 0.5 * (lo + hi) : secant;
  }
  return u;
}

}  // namespace

Response::Response(const ResponseSpec& spec, double lowest_slope, Reversal reversal)
    : law_(law_of(spec, lowest_slope, reversal)), limit_(spec.limit) {
  for (int i = 0; i <= 2000; ++i) {
    const double d = limit_ * i / 2000.0;
    largest_gap_ = std::max(largest_gap_, press(d) - release(d));
  }
}

double Response::press(double deflection) const noexcept {
  return with(law_, [&](const auto& law) { return law.press(deflection / limit_); });
}
double Response::release(double deflection) const noexcept {
  return with(law_, [&](const auto& law) { return law.release(deflection / limit_); });
}

double Response::force(ResponseState& state, double deflection) const noexcept {
  const double u = std::clamp(deflection / limit_, 0.0, 1.0);
  return with(law_, [&](const auto& law) {
    const double force = law.force(state, u);
    law.move(state, u);
    return force;
  });
}

double Response::deflection(ResponseState& state, double force, double most) const noexcept {
  return with(law_, [&](const auto& law) {
    const double end = std::min(1.0, most / limit_);
    const auto rise = [&](double u) { return law.force(state, u); };
    double u = 0.0;
    if (force > 0.0)  // the last answer is the best guess
      u = force >= rise(end) ? end : crossing(rise, force, end, state.deflection / limit_);
    law.move(state, u);
    if (u == end) state.deflection = std::min(most, limit_);  // end * limit may be off by one rounding
    return state.deflection;
  });
}

}  // namespace enc
