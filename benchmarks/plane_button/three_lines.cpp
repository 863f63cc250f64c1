// The fit of a button's curve: three lines, two breaks, one width.
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

#include "benchmarks/plane_button/plane_button.h"

namespace enc::bench::plane_button {
namespace {

using Coefficients = Eigen::Matrix<double, 6, 1>;  // offset and slope of each line
using Breaks = std::array<double, 3>;              // d1, d2, gradual, m

double gone_over(double depth, double from, double width) {
  const double s = std::clamp((depth - from) / width, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

// Least squares for given breaks: what is left, N^2.
double rest_of(const Curve& curve, const Breaks& breaks, Coefficients& best) {
  constexpr double kNarrowest = 0.02e-3, kRefused = 1e12;
  const auto [d1, d2, gradual] = breaks;
  if (gradual < kNarrowest || d2 < d1 + gradual || d1 < curve.depth.front() ||
      d2 + gradual > curve.depth.back())
    return kRefused;
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Coefficients right = Coefficients::Zero();
  double squares = 0.0;
  for (std::size_t i = 0; i < curve.depth.size(); ++i) {
    const double x = 1e3 * curve.depth[i];  // mm: offsets and slopes of one size
    const double past1 = gone_over(curve.depth[i], d1, gradual);
    const double past2 = gone_over(curve.depth[i], d2, gradual);
    const double share[3] = {1.0 - past1, past1 * (1.0 - past2), past1 * past2};
    Coefficients row;
    for (int k = 0; k < 3; ++k) row.segment<2>(2 * k) << share[k], share[k] * x;
    normal += row * row.transpose();
    right += curve.force[i] * row;
    squares += curve.force[i] * curve.force[i];
  }
  best = normal.ldlt().solve(right);
  return best.allFinite() ? squares - best.dot(right) : kRefused;
}

// The best of a coarse grid over the whole curve.
Breaks coarse(const Curve& curve) {
  constexpr double kStep = 0.2e-3;
  Breaks best{};
  double least = 1e300;
  Coefficients unused;
  const double first = curve.depth.front();
  const int steps = static_cast<int>((curve.depth.back() - first) / kStep);
  for (int i = 0; i < steps; ++i)
    for (int k = i + 1; k <= steps; ++k)
      for (const double gradual : {0.1e-3, 0.3e-3, 0.6e-3, 1.0e-3}) {
        const Breaks breaks{first + i * kStep, first + k * kStep, gradual};
        const double rest = rest_of(curve, breaks, unused);
        if (rest >= least) continue;
        least = rest;
        best = breaks;
      }
  return best;
}

// From there, each of the three in turn, by steps that become smaller.
Breaks refined(const Curve& curve, Breaks at) {
  Coefficients unused;
  double least = rest_of(curve, at, unused);
  for (double step = 0.1e-3; step > 0.2e-6;) {
    bool better = false;
    for (std::size_t which = 0; which < at.size(); ++which)
      for (const double way : {-step, step}) {
        Breaks next = at;
        next[which] += way;
        const double rest = rest_of(curve, next, unused);
        if (rest >= least) continue;
        least = rest;
        at = next;
        better = true;
      }
    if (!better) step *= 0.5;
  }
  return at;
}

}  // namespace

ThreeLines fit_three_lines(const Curve& curve) {
  constexpr std::size_t kLeast = 20;
  if (curve.depth.size() < kLeast) return {};
  const Breaks breaks = refined(curve, coarse(curve));
  Coefficients lines = Coefficients::Zero();
  const double rest = rest_of(curve, breaks, lines);
  ThreeLines fit{breaks[0], breaks[1], breaks[2]};
  for (int k = 0; k < 3; ++k) fit.slope[k] = 1e3 * lines[2 * k + 1];
  fit.rms = std::sqrt(std::max(0.0, rest) / static_cast<double>(curve.depth.size()));
  return fit;
}

}  // namespace enc::bench::plane_button
