// The two models of a response, and what makes them fit for an admittance.
#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/response/response.h"

namespace enc {
namespace {

using Coefficients = std::array<double, 4>;

double value(const Coefficients& c, double u) { return u * (c[0] + u * (c[1] + u * (c[2] + u * c[3]))); }
double slope(const Coefficients& c, double u) {
  return c[0] + u * (2 * c[1] + u * (3 * c[2] + u * 4 * c[3]));
}

// The first interval of [0, 1] on which f < 0, in steps fine enough that no dip of note hides between them.
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

// ---- energy stop ----------------------------------------------------------------------------------------

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

// ---- Prandtl-Ishlinskii ---------------------------------------------------------------------------------

PrandtlIshlinskii::PrandtlIshlinskii(const ResponseSpec& spec, double lowest_slope) : limit_(spec.limit) {
  if (!spec.stops)
    throw Error(
        "the response file has no [stops]; expected them for reversal = \"prandtl_ishlinskii\"; write the "
        "file "
        "with `encounter fit`, or set reversal = \"energy_stop\"",
        "reversal");
  const StopsSpec& s = *spec.stops;
  if (s.curve.empty() || s.curve.size() > kMaxCurve)
    throw Error("the stops' curve has 1 to " + std::to_string(kMaxCurve) + " coefficients", "stops.curve");
  if (s.radii.size() != s.weights.size() || s.radii.size() > kMaxStops)
    throw Error("each stop has a radius and a weight, and there are at most " + std::to_string(kMaxStops),
                "stops.weights");
  for (std::size_t k = 0; k < s.curve.size(); ++k) {
    if (!std::isfinite(s.curve[k])) throw Error("coefficients must be finite", "stops.curve");
    curve_[k] = s.curve[k];
  }
  for (std::size_t i = 0; i < s.radii.size(); ++i) {
    if (!(s.radii[i] > 0.0) || !std::isfinite(s.radii[i]))
      throw Error("the radius of a stop is a positive length", "stops.radii");
    if (!(s.weights[i] >= 0.0) || !std::isfinite(s.weights[i]))
      throw Error("the weight of a stop is 0 or more: a negative one would yield energy", "stops.weights");
    if (s.weights[i] == 0.0) continue;
    radius_[stops_] = s.radii[i];
    weight_[stops_++] = s.weights[i];
  }
  // Whatever came before, no stop at d is stretched less than after a press to the limit: its resting place
  // d - x only moves when it slides, so it lies between 0 and limit - r. The least slope is there; a stop
  // that does not slide only adds to it.
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

}  // namespace enc
