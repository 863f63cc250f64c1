#include "core/shape/response/response.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace enc {
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
    // Alternate with halving, so that a bracket end which does not move cannot stall the search.
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
    if (u == end) state.deflection = std::min(most, limit_);  // end * limit may be one rounding off
    return state.deflection;
  });
}

}  // namespace enc
