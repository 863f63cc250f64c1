#include "models/least_squares.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "core/base/error.h"

namespace enc::models {
namespace {

// Dual active-set method of Goldfarb and Idnani (Mathematical Programming 27, 1983). It starts at the
// unconstrained minimum and adds the most violated constraint, one at a time, keeping the multipliers of the
// active ones non-negative. The cost rises with each, so no active set returns and the end is the exact
// minimum. The problems are small, so everything is factored anew in each step.
class ActiveSet {
 public:
  explicit ActiveSet(const Quadratic& q) : factor_(q.gram), x_(factor_.solve(q.moment)) {}

  Eigen::VectorXd minimum(const Constraints& all, double tolerance) {
    if (all.bounds.size() == 0) return x_;
    for (int i = 0; i < 1000; ++i) {
      Eigen::Index worst = 0;
      const Eigen::VectorXd missed = all.bounds - all.normals * x_;
      if (missed.maxCoeff(&worst) <= tolerance) return x_;
      add(all.normals.row(worst), all.bounds[worst]);
    }
    throw Error("the fit of the loop does not settle", "loop");
  }

 private:
  // Steps until the constraint holds with equality, dropping constraints whose multiplier would turn
  // negative.
  void add(const Eigen::VectorXd& next, double bound) {
    double multiplier = 0.0;
    for (;;) {
      // The step direction is the part of next's normal that the active normals do not span, in the metric of
      // the cost.
      const Eigen::VectorXd normal = factor_.matrixL().solve(next);
      const Eigen::VectorXd share = spanned(normal);
      Eigen::VectorXd way = normal;
      for (std::size_t j = 0; j < active_.size(); ++j)
        way -= share[static_cast<Eigen::Index>(j)] * active_[j].normal;
      constexpr double kInfinite = std::numeric_limits<double>::infinity();
      double step = kInfinite;  // to equality
      if (way.squaredNorm() > 1e-14 * normal.squaredNorm()) step = (bound - next.dot(x_)) / way.squaredNorm();
      double allowed = kInfinite;  // until an active multiplier becomes zero
      std::size_t first = 0;
      for (std::size_t j = 0; j < active_.size(); ++j) {
        const double s = share[static_cast<Eigen::Index>(j)];
        if (s <= 0.0 || active_[j].multiplier >= allowed * s) continue;
        allowed = active_[j].multiplier / s;
        first = j;
      }
      const double taken = std::min(step, allowed);
      if (taken == kInfinite) throw Error("no curve meets the lowest slope", "loop");
      if (step != kInfinite) x_ += taken * factor_.matrixU().solve(way);
      for (std::size_t j = 0; j < active_.size(); ++j)
        active_[j].multiplier -= taken * share[static_cast<Eigen::Index>(j)];
      multiplier += taken;
      if (step <= allowed) {
        active_.push_back({normal, multiplier});
        return;
      }
      active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(first));
    }
  }

  // Least-squares coefficients of `normal` in the active normals.
  [[nodiscard]] Eigen::VectorXd spanned(const Eigen::VectorXd& normal) const {
    if (active_.empty()) return {};
    Eigen::MatrixXd normals(normal.size(), static_cast<Eigen::Index>(active_.size()));
    for (std::size_t j = 0; j < active_.size(); ++j)
      normals.col(static_cast<Eigen::Index>(j)) = active_[j].normal;
    return normals.householderQr().solve(normal);
  }

  struct ActiveConstraint {
    Eigen::VectorXd normal;  // metric of the cost
    double multiplier;
  };
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd x_;
  std::vector<ActiveConstraint> active_;
};

}  // namespace

Eigen::VectorXd constrained_minimum(const Quadratic& q, const Constraints& all, double tolerance) {
  return ActiveSet(q).minimum(all, tolerance);
}

}  // namespace enc::models
