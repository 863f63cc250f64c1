// The Prandtl-Ishlinskii model of a measured loop, by non-negative least squares.
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "models/identify/response/response_fit.h"

namespace enc::models {
namespace {

// Radii in equal ratios from 1/30 to 1/3 of the limit. Smaller ones only add stiffness for tremor; larger
// ones never reverse fully within the limit, and one loop cannot tell them from the curve.
constexpr int kStops = 12;
constexpr int kCurve = static_cast<int>(kMaxCurve);
constexpr int kStopUnknowns = kCurve + kStops;

std::vector<double> radii_for(double limit) {
  std::vector<double> radii;
  for (int i = 0; i < kStops; ++i) {
    // In tenths of a micrometre, as the file shows them.
    const double radius = limit / 30.0 * std::pow(10.0, static_cast<double>(i) / (kStops - 1));
    radii.push_back(std::round(radius * 1e7) / 1e7);
  }
  return radii;
}

using Row = Eigen::Matrix<double, kStopUnknowns, 1>;

// Force per unit of each unknown, along one press from rest. `see` is called with (row, point).
template <class F>
void walk(std::span<const LoopPoint> press, const std::vector<double>& radii, double limit, const F& see) {
  std::vector<double> stretch(radii.size(), 0.0);
  double before = 0.0;
  for (const LoopPoint& point : press) {
    const double d = std::min(point.deflection, limit);
    const double u = d / limit;
    Row row;
    double power = 1.0;
    for (int k = 0; k < kCurve; ++k) row[k] = power *= u;
    for (int i = 0; i < kStops; ++i) {
      double& x = stretch[static_cast<std::size_t>(i)];
      const double r = radii[static_cast<std::size_t>(i)];
      x = u > 0.0 ? std::clamp(x + d - before, -r, r) : 0.0;
      row[kCurve + i] = u * x;
    }
    before = d;
    if (u > 0.0 && point.deflection <= limit && !point.held) see(row, point);
  }
}

// Weights >= 0.
Constraints weights_only() {
  Constraints all{Eigen::MatrixXd::Zero(kStops, kStopUnknowns), Eigen::VectorXd::Zero(kStops)};
  all.normals.rightCols<kStops>().setIdentity();
  return all;
}

// And at 501 deflections the force rises at least with the lowest slope, whatever came before, and at most
// with the stiffest.
Constraints with_slopes(const std::vector<double>& radii, double limit, double lowest, double stiffest,
                        double margin) {
  constexpr int kSteps = 500;
  const Constraints weights = weights_only();
  Constraints all{Eigen::MatrixXd::Zero(kStops + 2 * (kSteps + 1), kStopUnknowns),
                  Eigen::VectorXd::Zero(kStops + 2 * (kSteps + 1))};
  all.normals.topRows<kStops>() = weights.normals;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = static_cast<double>(i) / kSteps;
    Row least;
    Row most;
    for (int k = 0; k < kCurve; ++k) least[k] = most[k] = (k + 1) * std::pow(u, k);
    for (int j = 0; j < kStops; ++j) {
      const double r = radii[static_cast<std::size_t>(j)];
      least[kCurve + j] = std::max(-r, r - limit * (1.0 - u));  // as in core's PrandtlIshlinskii
      most[kCurve + j] = std::min(r, limit * u) + u * limit;    // all stretched, none sliding
    }
    all.normals.row(kStops + 2 * i) = least;
    all.bounds[kStops + 2 * i] = lowest * limit + margin;
    all.normals.row(kStops + 2 * i + 1) = -most;
    all.bounds[kStops + 2 * i + 1] = -stiffest * limit;
  }
  return all;
}

double rmse(std::span<const std::vector<LoopPoint>> presses, const std::vector<double>& radii, double limit,
            const Eigen::VectorXd& x) {
  double sum = 0.0;
  double count = 0.0;
  for (const auto& press : presses)
    walk(press, radii, limit, [&](const Row& row, const LoopPoint& point) {
      sum += std::pow(row.dot(x) - point.force, 2);
      count += 1.0;
    });
  return std::sqrt(sum / count);
}

}  // namespace

StopsFit fit_stops(std::span<const std::vector<LoopPoint>> presses, double limit, double lowest_slope,
                   double stiffest) {
  const std::vector<double> radii = radii_for(limit);
  Quadratic q{Eigen::MatrixXd::Zero(kStopUnknowns, kStopUnknowns), Eigen::VectorXd::Zero(kStopUnknowns)};
  double largest = lowest_slope * limit;
  for (const auto& press : presses)
    walk(press, radii, limit, [&](const Row& row, const LoopPoint& point) {
      q.gram += row * row.transpose();
      q.moment += row * point.force;
      largest = std::max(largest, std::abs(point.force));
    });
  if (!(q.gram.diagonal().minCoeff() > 0.0)) throw Error("the loop has no readings within the limit", "loop");
  // Neighbouring stops are nearly alike: a part in 1e9 on the diagonal keeps the matrix definite.
  q.gram.diagonal() *= 1.0 + 1e-9;
  const double margin = 1e-4 * largest;
  const Eigen::VectorXd free = constrained_minimum(q, weights_only(), 1e-9 * largest / limit);
  Eigen::VectorXd x =
      constrained_minimum(q, with_slopes(radii, limit, lowest_slope, stiffest, margin), 0.01 * margin);
  for (Eigen::Index i = kCurve; i < kStopUnknowns; ++i)
    if (x[i] < 1e-6 * largest / limit) x[i] = 0.0;  // what the tolerance leaves of a weight of zero
  StopsFit fit;
  fit.spec = {{x.data(), x.data() + kCurve}, radii, {x.data() + kCurve, x.data() + kStopUnknowns}};
  fit.rmse = rmse(presses, radii, limit, x);
  fit.rmse_free = rmse(presses, radii, limit, free);
  return fit;
}

double fit_ceiling(const ResponseSpec& curves) {
  // A tremor of +-30 um at rest is felt as 60 um times the stiffness (sources/ball 6). The faster the force
  // may turn from pressing to releasing, the closer are the minor loops, and the stiffer is a tremor: a
  // passive force turns fastest at once. This share of the steepest press is the least at which the tennis
  // ball's minor loops stay within 0.08 N (tests/property/response_property_test.cpp).
  constexpr double kTremor = 1.65;
  double steepest = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double d = curves.limit * i / 1000.0;
    double slope = 0.0;
    for (std::size_t k = 4; k-- > 0;) slope = slope * d + static_cast<double>(k + 1) * curves.press[k];
    steepest = std::max(steepest, slope);
  }
  return kTremor * steepest;
}

}  // namespace enc::models
