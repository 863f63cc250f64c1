#include "core/response.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace enc {
namespace {

using Coefficients = std::array<double, 4>;

double value(const Coefficients& c, double u) { return u * (c[0] + u * (c[1] + u * (c[2] + u * c[3]))); }
double slope(const Coefficients& c, double u) {
  return c[0] + u * (2 * c[1] + u * (3 * c[2] + u * 4 * c[3]));
}

// The first interval of [0, 1] on which f < 0, in steps fine enough that no quartic's dip of note hides
// between them.
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

// A number to three decimals, without a locale.
std::string decimals(double x) {
  const auto thousandths = static_cast<long>(std::lround(x * 1e3));
  const std::string digits = std::to_string(thousandths % 1000);
  return std::to_string(thousandths / 1000) + "." + std::string(3 - digits.size(), '0') + digits;
}

}  // namespace

Response::Response(const ResponseSpec& spec, double lowest_slope) : limit_(spec.limit) {
  if (!(limit_ > 0.0) || !std::isfinite(limit_))
    throw Error("deflection limit must be a positive length", "limit");
  double power = 1.0;
  for (std::size_t k = 0; k < 4; ++k) {
    power *= limit_;
    press_[k] = spec.press[k] * power;
    release_[k] = spec.release[k] * power;
    if (!std::isfinite(press_[k]) || !std::isfinite(release_[k]))
      throw Error("coefficients must be finite", "press");
  }
  const auto refuse = [&](const Interval& bad, const char* curve, const std::string& what) {
    if (bad.found)
      throw Error(std::string(curve) + " curve " + what + " from " + decimals(bad.from * limit_ * 1e3) +
                      " to " + decimals(bad.to * limit_ * 1e3) +
                      " (deflection in millimetres); an admittance needs one deflection for each force",
                  curve);
  };
  const double floor = lowest_slope * limit_ * (1.0 - 1e-9);
  const std::string floor_text =
      "is softer than the loop renders stably (" + decimals(lowest_slope * 1e-3) + " N per millimetre)";
  refuse(first_below_zero([&](double u) { return slope(press_, u); }), "press", "falls with deflection");
  refuse(first_below_zero([&](double u) { return slope(release_, u); }), "release", "falls with deflection");
  refuse(first_below_zero([&](double u) { return slope(press_, u) - floor; }), "press", floor_text);
  refuse(first_below_zero([&](double u) { return slope(release_, u) - floor; }), "release", floor_text);
  refuse(first_below_zero([&](double u) { return value(press_, u) - value(release_, u) + 1e-9; }), "release",
         "is above the press curve");
  for (int i = 0; i <= 2000; ++i) {
    const double u = i / 2000.0;
    largest_gap_ = std::max(largest_gap_, value(press_, u) - value(release_, u));
  }
  stop_ = largest_gap_ * kBlend;
}

double Response::press(double deflection) const noexcept { return value(press_, deflection / limit_); }
double Response::release(double deflection) const noexcept { return value(release_, deflection / limit_); }

double Response::gap_integral(double u) const noexcept {
  double y = 0.0;
  for (std::size_t k = 4; k-- > 0;) y = u * (y + (press_[k] - release_[k]) / static_cast<double>(k + 2));
  return y * u * limit_;
}

double Response::alpha_at(const ResponseState& from, double u) const noexcept {
  if (u <= 0.0 || stop_ <= 0.0) return 1.0;  // recovered, or a curve without a loop
  const double travel = gap_integral(u) - gap_integral(from.deflection / limit_);
  return std::clamp(from.alpha + travel / stop_, 0.0, 1.0);
}

double Response::force(ResponseState& state, double deflection) const noexcept {
  const double u = std::clamp(deflection / limit_, 0.0, 1.0);
  state = {u * limit_, alpha_at(state, u)};
  return value(release_, u) + state.alpha * (value(press_, u) - value(release_, u));
}

double Response::deflection(ResponseState& state, double force, double most) const noexcept {
  const auto at = [&](double u) {
    const double released = value(release_, u);
    return released + alpha_at(state, u) * (value(press_, u) - released);
  };
  double lo = 0.0;
  double hi = std::min(1.0, most / limit_);
  const double end = hi;
  double u = 0.0;
  if (!(force > 0.0)) {
    u = 0.0;
  } else if (force >= at(end)) {
    u = end;
  } else {
    // at() rises strictly, with a kink where alpha saturates: secant steps (Illinois) inside a shrinking
    // bracket. Exact to 1e-13.
    double f_lo = -force;
    double f_hi = at(end) - force;
    u = std::clamp(state.deflection / limit_, 0.0, end);  // the last answer is the best guess
    for (int i = 0; i < 60; ++i) {
      const double f = at(u) - force;
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
  }
  this->force(state, u * limit_);
  return state.deflection;
}

}  // namespace enc
