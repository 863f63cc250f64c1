// Springs that slip, side by side: a response with hysteresis that remembers every reversal.
#include <algorithm>
#include <cmath>
#include <string>

#include "core/shape/response/admissible.h"
#include "core/shape/response/response.h"

namespace enc {

using response::first_below_zero;
using response::too_soft;

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
    response::refuse(first_below_zero([&](double u) { return least_slope(u) - least; }), limit_, "stops'",
                     "stops", what);
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
