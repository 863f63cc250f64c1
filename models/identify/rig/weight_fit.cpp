#include "models/identify/rig/weight_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/machine/arm.h"
#include "models/identify/rig/turn.h"

namespace enc::models {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Eigen::Index kWeightUnknowns = 7;  // turn, mass, zero
constexpr std::size_t kFewestWeighed = 6;    // stands
constexpr double kAxisOff = 0.2;             // of a sensor's axis that reads as it should, with sign and unit
constexpr double kSure = 4.0;                // standard deviations
constexpr double kMostLeftForce = 0.2;       // N rms: drift and noise of a sensor are far less

// The direction of weight in H, times g.
Vec3 weight_per_kg(const WeightStand& stand) {
  return stand.X_WH.q().conjugate() * Vec3(0.0, 0.0, -kStandardGravity);
}

struct Estimate {
  Mat3 R_FH = Mat3::Identity();
  double mass = kUnset;
  Vec3 zero{0, 0, 0};
};

// The sides of the weight's direction swing about nought and the third hardly changes: force against both is
// the first two columns of m R_FH, and the third is at right angles to them.
Estimate first_guess(std::span<const WeightStand> stands) {
  const auto n = static_cast<Eigen::Index>(stands.size());
  MatrixXd sides(n, 3), force(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const WeightStand& stand = stands[static_cast<std::size_t>(i)];
    const Vec3 w = weight_per_kg(stand);
    sides.row(i) << w.x(), w.y(), 1.0;
    force.row(i) = stand.wrench.force.e().transpose();
  }
  const Eigen::RowVectorXd middle = sides.colwise().mean();
  for (Eigen::Index side = 0; side < 2; ++side) {
    const double swing = std::sqrt((sides.col(side).array() - middle(side)).square().mean());
    if (!(swing >= kLeastWeightSwing * kStandardGravity))
      throw Error(
          fmt::format("the machine turned too little to tell weight from zero: the weight's direction swung "
                      "by {:.1f} degrees rms to one side; expected {:.0f}; visit poses that tilt more",
                      swing / kStandardGravity * 180.0 / M_PI, kLeastWeightSwing * 180.0 / M_PI));
  }
  const MatrixXd found = sides.colPivHouseholderQr().solve(force);  // rows: side x, side y, rest
  const Vec3 x = found.row(0).transpose(), y = found.row(1).transpose();
  Estimate guess;
  guess.mass = std::sqrt(x.norm() * y.norm());
  const double alike = x.norm() / y.norm(), square = x.dot(y) / (x.norm() * y.norm());
  if (!(guess.mass > 0.0) || !(std::abs(std::log(alike)) < 0.2) || !(std::abs(square) < 0.2))
    throw Error(
        fmt::format("the force does not turn as a weight does: tilting one way tells {:.3g} kg, the other "
                    "{:.3g}; expected nothing but weight on the sensor; see that nothing touches the tool, "
                    "that no cable pulls, and to the axes and units of the sensor",
                    x.norm(), y.norm()));
  Mat3 columns;
  columns << x / guess.mass, y / guess.mass, x.cross(y) / (guess.mass * guess.mass);
  guess.R_FH = nearest_rotation(columns);
  Vec3 rest = Vec3::Zero();
  for (const WeightStand& stand : stands)
    rest += stand.wrench.force.e() - guess.mass * guess.R_FH * weight_per_kg(stand);
  guess.zero = rest / static_cast<double>(stands.size());
  return guess;
}

Vec3 left_over(const WeightStand& stand, const Estimate& at) {
  return stand.wrench.force.e() - at.mass * at.R_FH * weight_per_kg(stand) - at.zero;
}

// What is fitted: stands, and the time at which the zero is told.
struct Log {
  std::span<const WeightStand> stands;
  double end;
};

// One axis of all stands: independent errors and a walk of the zero, which is nought at the end. ratio:
// variance of the walk a second, over that of a stand's mean.
MatrixXd covariance(const Log& log, double ratio) {
  const auto& [stands, last] = log;
  const auto n = static_cast<Eigen::Index>(stands.size());
  MatrixXd all = MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      all(i, j) += ratio * std::min(last - stands[static_cast<std::size_t>(i)].time,
                                    last - stands[static_cast<std::size_t>(j)].time);
  return all;
}

struct Solved {
  Estimate at;
  MatrixXd inverse;                                              // of the normal matrix
  double variance = kUnset;                                      // of a stand's mean
  double likelihood = -std::numeric_limits<double>::infinity();  // restricted, logarithm
  double ratio = 0.0;
};

// Rows of one axis together, so that each axis is whitened by the same triangle.
struct Whitened {
  MatrixXd by;
  VectorXd left;
};
Whitened whitened(std::span<const WeightStand> stands, const Estimate& at, const Eigen::LLT<MatrixXd>& root) {
  const auto n = static_cast<Eigen::Index>(stands.size());
  Whitened w{MatrixXd::Zero(3 * n, kWeightUnknowns), VectorXd(3 * n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const WeightStand& stand = stands[static_cast<std::size_t>(i)];
    const Vec3 each = at.R_FH * weight_per_kg(stand), left = left_over(stand, at);
    const Mat3 by_turn = -at.mass * cross_matrix(each);  // exp(turn) R_FH
    for (Eigen::Index a = 0; a < 3; ++a) {
      w.left(a * n + i) = left(a);
      w.by.block<1, 3>(a * n + i, 0) = by_turn.row(a);
      w.by(a * n + i, 3) = each(a);
      w.by(a * n + i, 4 + a) = 1.0;
    }
  }
  for (Eigen::Index a = 0; a < 3; ++a) {
    w.by.middleRows(a * n, n) = root.matrixL().solve(w.by.middleRows(a * n, n));
    w.left.segment(a * n, n) = root.matrixL().solve(w.left.segment(a * n, n));
  }
  return w;
}

Solved solved(const Log& log, Estimate at, double ratio) {
  const std::span<const WeightStand> stands = log.stands;
  const Eigen::LLT<MatrixXd> root(covariance(log, ratio));
  Solved result;
  result.ratio = ratio;
  constexpr int kRounds = 20;
  Whitened w = whitened(stands, at, root);
  for (int round = 0; round < kRounds; ++round) {
    const VectorXd step = w.by.colPivHouseholderQr().solve(w.left);
    at.R_FH = (turn_by(step.head<3>()) * Quat(at.R_FH)).normalized().toRotationMatrix();
    at.mass += step(3);
    at.zero += step.tail<3>();
    w = whitened(stands, at, root);
    if (step.norm() < 1e-12) break;
  }
  const MatrixXd normal = w.by.transpose() * w.by;
  const double freedom = 3.0 * static_cast<double>(stands.size()) - static_cast<double>(kWeightUnknowns);
  constexpr double kExact = 1e-18;  // N^2: a sensor without any error
  result.at = at;
  result.inverse = normal.inverse();
  result.variance = std::max(kExact, w.left.squaredNorm() / freedom);
  const double spread = 2.0 * MatrixXd(root.matrixL()).diagonal().array().log().sum();
  const double known = std::log(std::max(normal.determinant(), std::numeric_limits<double>::min()));
  result.likelihood = -0.5 * (freedom * std::log(result.variance) + 3.0 * spread + known);
  return result;
}

Solved best_of(const Log& log, const Estimate& guess) {
  Solved best = solved(log, guess, 0.0);
  for (int i = -16; i <= 16; ++i) {
    const Solved one = solved(log, guess, std::pow(10.0, 0.25 * i));
    if (one.likelihood > best.likelihood) best = one;
  }
  return best;
}

// Each axis of the sensor against what it should read: 1 where its sign and its unit are right. A turn and a
// zero make up for a wrong axis but for how the weight along it changes, which is what tells it.
struct AxisSlope {
  double value = kUnset, deviation = kUnset;
};
AxisSlope slope_of(const Log& log, const Solved& found, Eigen::Index axis) {
  const auto n = static_cast<Eigen::Index>(log.stands.size());
  MatrixXd by(n, 2);
  VectorXd read(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const WeightStand& stand = log.stands[static_cast<std::size_t>(i)];
    by.row(i) << (found.at.mass * found.at.R_FH * weight_per_kg(stand))(axis), 1.0;
    read(i) = stand.wrench.force.e()(axis);
  }
  const Eigen::LLT<MatrixXd> root(covariance(log, found.ratio));
  by = root.matrixL().solve(by);
  read = root.matrixL().solve(read);
  const MatrixXd inverse = (by.transpose() * by).inverse();
  const VectorXd slope = inverse * (by.transpose() * read);
  const double left = (read - by * slope).squaredNorm() / static_cast<double>(n - 2);
  return {slope(0), std::sqrt(std::max(left, 1e-18) * inverse(0, 0))};
}

void check_axes(const Log& log, const Solved& found) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const AxisSlope slope = slope_of(log, found, axis);
    const double off = std::abs(slope.value - 1.0);
    if (off <= kAxisOff && kSure * slope.deviation <= 1.0) continue;
    if (off <= kAxisOff || off <= kSure * slope.deviation)
      throw Error(fmt::format(
          "sign and unit of the force sensor's {} are not told by these poses: it reads {:.2f} +- "
          "{:.2f} of what it should; expected 1; visit more poses, or wait until its zero is "
          "steady",
          "xyz"[axis], slope.value, kSure * slope.deviation));
    throw Error(fmt::format(
        "the force sensor's {} reads {:.2f} +- {:.2f} of what it should; expected 1; see to the sign, "
        "the unit and the cable of that axis",
        "xyz"[axis], slope.value, kSure * slope.deviation));
  }
}

// torque(i) = middle x weight(i) + its zero: all linear.
Vec<'F'> middle_of(std::span<const WeightStand> stands, const Estimate& at) {
  const auto n = static_cast<Eigen::Index>(stands.size());
  MatrixXd by(3 * n, 6);
  VectorXd torque(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const WeightStand& stand = stands[static_cast<std::size_t>(i)];
    const Vec3 weight = at.mass * at.R_FH * weight_per_kg(stand);
    by.block<3, 3>(3 * i, 0) = -cross_matrix(weight);
    by.block<3, 3>(3 * i, 3) = Mat3::Identity();
    torque.segment<3>(3 * i) = stand.wrench.torque.e();
  }
  return Vec<'F'>(Vec3(by.colPivHouseholderQr().solve(torque).head<3>()));
}

}  // namespace

WeightFit fit_weight(std::span<const WeightStand> stands, double end) {
  if (stands.size() < kFewestWeighed)
    throw Error(fmt::format("{} stands of the machine; expected {} or more; visit more poses", stands.size(),
                            kFewestWeighed));
  const double last = stands.back().time;
  const Log log{stands, end > last ? end : last};
  const Solved found = best_of(log, first_guess(stands));
  const double freedom = 3.0 * static_cast<double>(stands.size()) - static_cast<double>(kWeightUnknowns);
  const double reach = student(freedom, kNormal99) * std::sqrt(found.variance);
  const VectorXd half = reach * found.inverse.diagonal().cwiseSqrt();
  WeightFit fit;
  fit.mass = {found.at.mass, half(3)};
  fit.zero = {found.at.zero, half.tail<3>()};
  fit.R_HF = Quat(Mat3(found.at.R_FH.transpose()));
  fit.turn_half = half.head<3>();
  fit.middle = middle_of(stands, found.at);
  fit.walk = std::sqrt(found.ratio * found.variance);
  double squares = 0.0;
  fit.most = 0.0;
  for (const WeightStand& stand : stands) {
    const double far = left_over(stand, found.at).norm();
    squares += far * far;
    fit.most = std::max(fit.most, far);
  }
  fit.rms = std::sqrt(squares / static_cast<double>(stands.size()));
  if (!(fit.rms <= kMostLeftForce))
    throw Error(
        fmt::format("a weight and a zero leave {:.3g} N rms of the force over, {:.3g} at most; expected at "
                    "most {:g}; see that nothing touches the tool and that no cable pulls",
                    fit.rms, fit.most, kMostLeftForce));
  check_axes(log, found);
  return fit;
}

}  // namespace enc::models
