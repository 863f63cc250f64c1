#include "models/response_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>

#include "core/error.h"

namespace enc::models {
namespace {

// Unknowns: press then release coefficients of u^1..u^4, u = deflection / limit. They are in N and of like
// size.
constexpr int kTerms = 4;
constexpr int kUnknowns = 2 * kTerms;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Square = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Terms = Eigen::Matrix<double, kTerms, 1>;

// minimise 1/2 x' gram x - moment' x
struct Quadratic {
  Square gram = Square::Zero();
  Unknowns moment = Unknowns::Zero();
};

// normal' x >= bound
struct Constraint {
  Unknowns normal = Unknowns::Zero();
  double bound = 0.0;
};

Terms powers(double u) { return {u, u * u, u * u * u, u * u * u * u}; }
int offset(bool pressing) { return pressing ? 0 : kTerms; }

bool used(const LoopPoint& point, double limit) {
  return point.deflection >= 0.0 && point.deflection <= limit;
}

Quadratic sum_up(std::span<const LoopPoint> loop, double limit) {
  Quadratic q;
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

// What makes the curves renderable, at 1001 deflections. Each with a margin (N, 1e-5 of the force) that
// covers what the polynomials do between two of them: a curvature c over u dips by c / (8 x 1000^2) at most,
// so up to 80 x the force is covered (the ball has 21 x).
std::vector<Constraint> renderable(double lowest_slope, double limit, double margin) {
  constexpr std::size_t kSteps = 1000;
  std::vector<Constraint> all;
  all.reserve(3 * (kSteps + 1));
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(kSteps);
    const Terms slope(1.0, 2.0 * u, 3.0 * u * u, 4.0 * u * u * u);
    for (const bool pressing : {true, false}) {
      Constraint c;
      c.normal.segment<kTerms>(offset(pressing)) = slope;
      c.bound = lowest_slope * limit + margin;
      all.push_back(c);
    }
    // (press - release) / u: the same sign as the gap, and it says something at u = 0 too
    const Terms gap(1.0, u, u * u, u * u * u);
    Constraint c;
    c.normal << gap, -gap;
    c.bound = margin;
    all.push_back(c);
  }
  return all;
}

// Dual active-set method of Goldfarb and Idnani (Mathematical Programming 27, 1983). Starts at the
// unconstrained minimum and adds the most violated constraint, one at a time, keeping the multipliers of the
// active ones non-negative. The cost rises with each, so no active set returns and the end is the exact
// minimum. Eight unknowns: everything is factored anew in each step.
class ActiveSet {
 public:
  explicit ActiveSet(const Quadratic& q) : factor_(q.gram), x_(factor_.solve(q.moment)) {}

  Unknowns minimum(const std::vector<Constraint>& all, double tolerance) {
    for (int i = 0; i < 1000; ++i) {
      const Constraint* worst = nullptr;
      double most = tolerance;
      for (const Constraint& c : all) {
        const double violation = c.bound - c.normal.dot(x_);
        if (violation > most) worst = &c;
        most = std::max(most, violation);
      }
      if (worst == nullptr) return x_;
      add(*worst);
    }
    throw Error("the fit of the loop does not settle", "loop");
  }

 private:
  // Steps until `next` holds with equality, dropping the constraints that would have to pull.
  void add(const Constraint& next) {
    double multiplier = 0.0;
    for (;;) {
      // In the metric of the cost: the part of next's normal that the active normals do not span is the way
      // to go.
      const Unknowns normal = factor_.matrixL().solve(next.normal);
      const Eigen::VectorXd share = spanned(normal);
      Unknowns way = normal;
      for (std::size_t j = 0; j < active_.size(); ++j) way -= share[static_cast<int>(j)] * active_[j].normal;
      constexpr double kInfinite = std::numeric_limits<double>::infinity();
      double step = kInfinite;  // to equality
      if (way.squaredNorm() > 1e-14 * normal.squaredNorm())
        step = (next.bound - next.normal.dot(x_)) / way.squaredNorm();
      double allowed = kInfinite;  // until an active multiplier vanishes
      std::size_t first = 0;
      for (std::size_t j = 0; j < active_.size(); ++j) {
        const double s = share[static_cast<int>(j)];
        if (s <= 0.0 || active_[j].multiplier >= allowed * s) continue;
        allowed = active_[j].multiplier / s;
        first = j;
      }
      const double taken = std::min(step, allowed);
      if (std::isinf(taken)) throw Error("no curve meets the lowest slope", "loop");
      if (!std::isinf(step)) x_ += taken * factor_.matrixU().solve(way);
      for (std::size_t j = 0; j < active_.size(); ++j)
        active_[j].multiplier -= taken * share[static_cast<int>(j)];
      multiplier += taken;
      if (step <= allowed) {
        active_.push_back({normal, multiplier});
        return;
      }
      active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(first));
    }
  }

  // Coefficients of the active normals that come nearest to `normal`.
  [[nodiscard]] Eigen::VectorXd spanned(const Unknowns& normal) const {
    if (active_.empty()) return {};
    Eigen::MatrixXd normals(kUnknowns, static_cast<int>(active_.size()));
    for (std::size_t j = 0; j < active_.size(); ++j) normals.col(static_cast<int>(j)) = active_[j].normal;
    return normals.householderQr().solve(normal);
  }

  struct Active {
    Unknowns normal;  // in the metric of the cost
    double multiplier;
  };
  Eigen::LLT<Square> factor_;
  Unknowns x_;
  std::vector<Active> active_;
};

// Four deflections on either curve, well apart: else the matrix of the least squares is singular.
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

double rmse(std::span<const LoopPoint> loop, double limit, const Unknowns& x, bool pressing) {
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

}  // namespace

ResponseFit fit_response(std::span<const LoopPoint> loop, double limit, double lowest_slope) {
  if (!(limit > 0.0) || !std::isfinite(limit))
    throw Error("deflection limit must be a positive length", "limit");
  if (!(lowest_slope >= 0.0) || !std::isfinite(lowest_slope))
    throw Error("lowest slope must be 0 or more", "floor");
  const Quadratic q = sum_up(loop, limit);
  must_determine(q);
  double largest = lowest_slope * limit;
  for (const LoopPoint& point : loop) largest = std::max(largest, std::abs(point.force));
  ActiveSet solver(q);
  const Unknowns free = solver.minimum({}, 0.0);
  const double margin = 1e-5 * largest;
  const Unknowns x = solver.minimum(renderable(lowest_slope, limit, margin), 0.01 * margin);
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
  static_cast<void>(Response(fit.spec, lowest_slope));  // throws if, against the above, it would be refused
  return fit;
}

}  // namespace enc::models
