#include "models/identify/response/response_fit.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

#include "core/base/error.h"
#include "models/schema/units.h"

namespace enc::models {
namespace {

// Unknowns: press, then release coefficients of u^1..u^4, u = deflection / limit. They are in N and of
// similar size.
constexpr int kTerms = 4;
constexpr int kUnknowns = 2 * kTerms;
using Terms = Eigen::Matrix<double, kTerms, 1>;

Terms powers(double u) { return {u, u * u, u * u * u, u * u * u * u}; }
int offset(bool pressing) { return pressing ? 0 : kTerms; }

bool used(const LoopPoint& point, double limit) {
  return point.deflection >= 0.0 && point.deflection <= limit;
}

// Each curve needs four well-separated deflections; otherwise the matrix of the least squares is singular.
void must_determine(const Quadratic& q) {
  for (const bool pressing : {true, false}) {
    const int at = offset(pressing);
    const Eigen::LLT<Eigen::Matrix4d> factor(q.gram.block<kTerms, kTerms>(at, at));
    const Terms pivots = Eigen::Matrix4d(factor.matrixL()).diagonal();
    if (factor.info() != Eigen::Success || !(pivots.minCoeff() > 1e-6 * pivots.maxCoeff()))
      throw Error(
          std::string(
              "the loop needs readings at four deflections or more within the limit, well apart, while ") +
              (pressing ? "pressing" : "releasing"),
          "loop");
  }
}

double rmse(std::span<const LoopPoint> loop, double limit, const Eigen::VectorXd& x, bool pressing) {
  double sum = 0.0;
  int count = 0;
  for (const LoopPoint& point : loop) {
    if (point.pressing != pressing || !used(point, limit)) continue;
    const double force = powers(point.deflection / limit).dot(x.segment<kTerms>(offset(pressing)));
    sum += (force - point.force) * (force - point.force);
    ++count;
  }
  return std::sqrt(sum / count);
}

void find_moved(const Eigen::VectorXd& free, const Eigen::VectorXd& x, double limit, ResponseFit& fit) {
  constexpr int kSteps = 100;
  for (const bool pressing : {true, false})
    for (int i = 1; i <= kSteps; ++i) {
      const double u = static_cast<double>(i) / kSteps;
      const auto force = [&](const Eigen::VectorXd& of) {
        return powers(u).dot(of.segment<kTerms>(offset(pressing)));
      };
      const double measured = force(free), fitted = force(x);
      if (i == kSteps && pressing) fit.measured_end = measured;
      if (std::abs(fitted - measured) <= std::abs(fit.fitted - fit.measured)) continue;
      fit.moved_at = u * limit, fit.measured = measured, fit.fitted = fitted, fit.moved_press = pressing;
    }
}

double parsed(const std::string& text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Rounds a number to so many decimals in the file's unit, and returns it in SI. It goes by way of text,
// because the file is text.
double decimal(const Unit& unit, double si, int k, int decimals) {
  const double in_file = si / to_si(unit, 1.0, k);
  return to_si(unit,
               parsed(fmt::format("{}e-{}", std::llround(in_file * std::pow(10.0, decimals)), decimals)), k);
}

}  // namespace

Quadratic normal_equations(std::span<const LoopPoint> loop, double limit) {
  Quadratic q{Eigen::MatrixXd::Zero(kUnknowns, kUnknowns), Eigen::VectorXd::Zero(kUnknowns)};
  for (const LoopPoint& point : loop) {
    if (!std::isfinite(point.deflection) || !std::isfinite(point.force))
      throw Error("a reading of the loop is not a finite number", "loop");
    if (!used(point, limit)) continue;
    const Terms p = powers(point.deflection / limit);
    const int at = offset(point.pressing);
    q.gram.block<kTerms, kTerms>(at, at) += p * p.transpose();
    q.moment.segment<kTerms>(at) += p * point.force;
  }
  return q;
}

// Conditions that make the curves renderable, at 1001 deflections. Each has a margin (N, 1e-5 of the force)
// for the polynomials between two of them. A curvature c over u dips by at most c / (8 x 1000^2), so up to 80
// x the force is covered (the ball has 21 x).
Constraints renderable(double lowest_slope, double limit, double margin) {
  constexpr int kSteps = 1000;
  Constraints all{Eigen::MatrixXd::Zero(3 * (kSteps + 1), kUnknowns), Eigen::VectorXd(3 * (kSteps + 1))};
  for (int i = 0; i <= kSteps; ++i) {
    const double u = static_cast<double>(i) / kSteps;
    const Terms slope(1.0, 2.0 * u, 3.0 * u * u, 4.0 * u * u * u);
    all.normals.row(3 * i).head<kTerms>() = slope;
    all.normals.row(3 * i + 1).tail<kTerms>() = slope;
    all.bounds[3 * i] = all.bounds[3 * i + 1] = lowest_slope * limit + margin;
    // (press - release) / u: it has the sign of the gap, and is also a condition at u = 0
    const Terms gap(1.0, u, u * u, u * u * u);
    all.normals.row(3 * i + 2) << gap.transpose(), -gap.transpose();
    all.bounds[3 * i + 2] = margin;
  }
  return all;
}

ResponseFit fit_response(std::span<const LoopPoint> loop, double limit, double lowest_slope) {
  if (!(limit > 0.0) || !std::isfinite(limit))
    throw Error("deflection limit must be a positive length", "limit");
  if (!(lowest_slope >= 0.0) || !std::isfinite(lowest_slope))
    throw Error("lowest slope must be 0 or more", "floor");
  const Quadratic q = normal_equations(loop, limit);
  must_determine(q);
  double largest = lowest_slope * limit;
  for (const LoopPoint& point : loop) largest = std::max(largest, std::abs(point.force));
  const double margin = 1e-5 * largest;
  const Eigen::VectorXd free = constrained_minimum(q, {}, 0.0);
  const Eigen::VectorXd x = constrained_minimum(q, renderable(lowest_slope, limit, margin), 0.01 * margin);
  ResponseFit fit;
  double power = 1.0;
  for (int k = 0; k < kTerms; ++k) {
    power *= limit;
    fit.spec.press[static_cast<std::size_t>(k)] = x[k] / power;
    fit.spec.release[static_cast<std::size_t>(k)] = x[kTerms + k] / power;
  }
  fit.spec.limit = limit;
  fit.rmse_press = rmse(loop, limit, x, true);
  fit.rmse_release = rmse(loop, limit, x, false);
  fit.rmse_press_free = rmse(loop, limit, free, true);
  fit.rmse_release_free = rmse(loop, limit, free, false);
  find_moved(free, x, limit, fit);
  static_cast<void>(Response(fit.spec, lowest_slope));  // throws if core would refuse it nevertheless
  return fit;
}

double fit_floor(const LoopModel& loop) {
  // Two figures for the softest object that the loop renders stably: the linear theory, and 0.17 of the
  // hand's stiffness (sources/ball 5: result of simulated presses with a softer hand). Takes the larger one
  // plus 5 %, so that a file is not refused for its last digit.
  constexpr double kShare = 0.17;
  constexpr double kMargin = 1.05;
  return kMargin * std::max(lowest_stable_stiffness(loop), kShare * loop.hand_stiffness);
}

ResponseSpec rounded(const ResponseSpec& spec) {
  ResponseSpec r = spec;
  const Unit& per_power = unit_of("press_N_per_mm_k");
  for (std::size_t i = 0; i < r.press.size(); ++i) {  // 1e-8 N/mm^k: 1e-5 N at 6 mm
    const int k = static_cast<int>(i) + 1;
    r.press[i] = decimal(per_power, r.press[i], k, 8);
    r.release[i] = decimal(per_power, r.release[i], k, 8);
  }
  if (!r.stops) return r;
  for (double& c : r.stops->curve) c = decimal(unit_of("curve_N"), c, 1, 6);
  for (double& radius : r.stops->radii) radius = decimal(unit_of("radii_mm"), radius, 1, 4);
  for (double& w : r.stops->weights) w = decimal(unit_of("weights_N_per_mm"), w, 1, 6);
  return r;
}

// ---- The Prandtl-Ishlinskii model of a measured loop, by non-negative least squares.

namespace {

// Radii in equal ratios from 1/30 to 1/3 of the limit. Smaller ones only add stiffness for tremor. Larger
// ones never reverse fully within the limit, and one loop cannot separate them from the curve.
constexpr int kStops = 12;
constexpr int kCurve = static_cast<int>(kMaxCurve);
constexpr int kStopUnknowns = kCurve + kStops;

std::vector<double> radii_for(double limit) {
  std::vector<double> radii;
  for (int i = 0; i < kStops; ++i) {
    // Rounded to tenths of a micrometre, as in the file.
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

// Also requires at 501 deflections that the force rises at least with the lowest slope, whatever the history,
// and at most with the stiffest.
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
  // Neighbouring stops are nearly collinear: 1e-9 on the diagonal keeps the matrix definite.
  q.gram.diagonal() *= 1.0 + 1e-9;
  const double margin = 1e-4 * largest;
  const Eigen::VectorXd free = constrained_minimum(q, weights_only(), 1e-9 * largest / limit);
  Eigen::VectorXd x =
      constrained_minimum(q, with_slopes(radii, limit, lowest_slope, stiffest, margin), 0.01 * margin);
  for (Eigen::Index i = kCurve; i < kStopUnknowns; ++i)
    if (x[i] < 1e-6 * largest / limit) x[i] = 0.0;  // remainder of a zero weight within the tolerance
  StopsFit fit;
  fit.spec = {{x.data(), x.data() + kCurve}, radii, {x.data() + kCurve, x.data() + kStopUnknowns}};
  fit.rmse = rmse(presses, radii, limit, x);
  fit.rmse_free = rmse(presses, radii, limit, free);
  return fit;
}

double fit_ceiling(const ResponseSpec& curves) {
  // A tremor of +-30 um at rest feels like 60 um times the stiffness (sources/ball 6). The faster the force
  // may turn from pressing to releasing, the narrower are the minor loops, and the stiffer a tremor feels: a
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
