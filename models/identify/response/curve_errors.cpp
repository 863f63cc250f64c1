#include "models/identify/response/curve_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "models/identify/block_error.h"

namespace enc::models {

CurveErrors::CurveErrors(const LoopData& loop, const Response& response, bool pressing)
    : response_(response), pressing_(pressing), zero_(loop.zero_error), begin_(loop.begin_error) {
  double presses = 0.0, sum = 0.0, squares = 0.0;
  for (const auto& press : loop.moving) {
    double own = 0.0, count = 0.0;
    for (const LoopPoint& p : press) {
      if (p.pressing != pressing || p.deflection > response.limit()) continue;
      const double fitted = pressing ? response.press(p.deflection) : response.release(p.deflection);
      residuals_.push_back({p.deflection, p.force - fitted});
      own += p.force - fitted;
      count += 1.0;
    }
    if (!(count > 0.0)) continue;
    presses += 1.0;
    sum += own / count;
    squares += own / count * own / count;
  }
  if (presses > 1.0)
    repeats_ = student(presses - 1.0) *
               std::sqrt(std::max(0.0, squares - sum * sum / presses) / (presses - 1.0) / presses);
  for (const Residual& r : residuals_) scatter_ += r.force * r.force;
  scatter_ = std::sqrt(scatter_ / std::max<double>(1.0, static_cast<double>(residuals_.size())));
  std::sort(residuals_.begin(), residuals_.end(),
            [](const Residual& a, const Residual& b) { return a.deflection < b.deflection; });
}

double CurveErrors::half(double deflection, double noise) const {
  const double chance =
      std::hypot(std::hypot(noise, repeats_), kNormal95 * std::hypot(zero_, slope(deflection) * begin_));
  return chance + misfit(deflection);
}

double CurveErrors::slope(double deflection) const {
  const double step = 1e-3 * response_.limit();
  const auto force = [&](double d) { return pressing_ ? response_.press(d) : response_.release(d); };
  const double to = std::min(deflection, response_.limit()), from = std::max(0.0, to - step);
  return (force(to) - force(from)) / (to - from);
}

// The most that readings around a deflection leave over in the mean: over a width in which there are enough
// of them, here and to either side.
double CurveErrors::misfit(double deflection) const {
  constexpr double kShare = 1.0 / 50.0, kGrows = 1.25;
  const double least = response_.limit() / 200.0, most = response_.limit() / 4.0;
  const double enough = std::clamp(kShare * static_cast<double>(residuals_.size()), 30.0, 150.0);
  double width = least, nearest = INFINITY;
  for (const Residual& r : residuals_) nearest = std::min(nearest, std::abs(r.deflection - deflection));
  width = std::max(width, 3.0 * nearest);
  const auto within = [&](double w) {
    const auto below = [](const Residual& r, double d) { return r.deflection < d; };
    const auto from = std::lower_bound(residuals_.begin(), residuals_.end(), deflection - w, below);
    const auto to = std::lower_bound(residuals_.begin(), residuals_.end(), deflection + w, below);
    return static_cast<double>(to - from);
  };
  while (within(width) < enough && width < most) width *= kGrows;
  double worst = 0.0;
  for (const double side : {-1.0, 0.0, 1.0})
    worst =
        std::max(worst, misfit_within(std::clamp(deflection + side * width, 0.0, response_.limit()), width));
  return worst;
}

// The size of a straight line through the residuals around a deflection, there, and its standard deviation.
double CurveErrors::misfit_within(double deflection, double width) const {
  double n = 0.0, x = 0.0, xx = 0.0, y = 0.0, xy = 0.0;
  for (const Residual& r : residuals_) {
    const double off = r.deflection - deflection;
    if (std::abs(off) > width) continue;
    n += 1.0, x += off, xx += off * off, y += r.force, xy += off * r.force;
  }
  const double spread = n * xx - x * x;
  if (!(n > 2.0) || !(spread > 0.0)) return scatter_;
  return std::abs(xx * y - x * xy) / spread + scatter_ * std::sqrt(xx / spread);
}

}  // namespace enc::models
