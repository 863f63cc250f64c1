// Least squares under linear inequalities, for fitting curves that a machine can render.
#pragma once

#include <Eigen/Core>

namespace enc::models {

// minimise 1/2 x' gram x - moment' x; gram symmetric and positive definite
struct Quadratic {
  Eigen::MatrixXd gram;
  Eigen::VectorXd moment;
};

// normals * x >= bounds, row by row
struct Constraints {
  Eigen::MatrixXd normals;
  Eigen::VectorXd bounds;
};

// The exact minimum; constraints may be violated by `tolerance`. Throws Error if no x satisfies them all.
// With x >= 0 as the only constraints, this is non-negative least squares.
[[nodiscard]] Eigen::VectorXd constrained_minimum(const Quadratic& q, const Constraints& all,
                                                  double tolerance);

}  // namespace enc::models
