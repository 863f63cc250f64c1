// The press and release polynomials, and what lies between them [VHMR 3.4].
#include <algorithm>
#include <cmath>
#include <string>

#include "core/shape/response/admissible.h"
#include "core/shape/response/response.h"

namespace enc {
namespace {

using response::first_below_zero;
using response::too_soft;

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
    response::refuse(first_below_zero(f), limit_, curve, curve, what);
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

}  // namespace enc
