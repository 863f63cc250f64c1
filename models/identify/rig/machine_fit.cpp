#include "models/identify/rig/machine_fit.h"

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
using Mat9 = Eigen::Matrix<double, 9, 9>;

constexpr std::size_t kFewestSeen = 12;     // stands: with fewer, the intervals were too narrow
constexpr Eigen::Index kPoseUnknowns = 12;  // position and rotation of both poses
constexpr double kLeastSecondTurn = 0.035;  // rad rms about each axis except the best two: 2 degrees
constexpr double kMostLeftPlace = 2e-3;     // m rms
constexpr double kMostLeftTurn = 0.03;      // rad rms
constexpr double kScaleOff = 0.005;         // share of a tracker's lengths: a good one has a tenth
constexpr double kScaleSure = 4.0;          // standard deviations
constexpr double kExactPlace = 1e-8, kExactTurn = 1e-9;  // m, rad: no device is better

struct PosePair {
  Pose<'W', 'C'> X_WC;
  Pose<'H', 'T'> X_HT;
};

// Rotations about a single axis leave the tool's position along it undetermined; two axes are needed.
void check_turns(std::span<const EyeStand> stands) {
  Mat3 scatter = Mat3::Zero();
  const Quat first = stands.front().X_WH.q();
  Vec3 middle = Vec3::Zero();
  const double each = 1.0 / static_cast<double>(stands.size());
  for (const EyeStand& stand : stands) middle += each * turn_of(first.conjugate() * stand.X_WH.q());
  for (const EyeStand& stand : stands) {
    const Vec3 turn = turn_of(first.conjugate() * stand.X_WH.q()) - middle;
    scatter += each * turn * turn.transpose();
  }
  const Vec3 known = Eigen::JacobiSVD<Mat3>(scatter).singularValues();
  if (!(std::sqrt(known(1)) >= kLeastSecondTurn))
    throw Error(
        fmt::format("the machine turned about one axis alone, {:.1f} degrees rms about a second one; "
                    "expected {:.0f} about two; visit poses that tilt to all sides",
                    std::sqrt(known(1)) * 180.0 / M_PI, kLeastSecondTurn * 180.0 / M_PI));
}

Mat3 rotation_of(const Eigen::Matrix<double, 9, 1>& stacked) {
  const Mat3 m = Eigen::Map<const Mat3>(stacked.data());  // column by column
  return nearest_rotation(m.determinant() < 0.0 ? Mat3(-m) : m);
}

PosePair first_guess(std::span<const EyeStand> stands) {
  Mat9 K = Mat9::Zero();
  for (const EyeStand& stand : stands) {
    const Mat3 A = stand.X_WH.q().toRotationMatrix(), B = stand.X_CT.q().toRotationMatrix();
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = 0; j < 3; ++j) K.block<3, 3>(3 * i, 3 * j) += B(i, j) * A;
  }
  const Eigen::JacobiSVD<Mat9> svd(K, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 R_HT = rotation_of(svd.matrixV().col(0)), R_WC = rotation_of(svd.matrixU().col(0));
  const auto n = static_cast<Eigen::Index>(stands.size());
  MatrixXd by(3 * n, 6);
  VectorXd apart(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const EyeStand& stand = stands[static_cast<std::size_t>(i)];
    by.block<3, 3>(3 * i, 0) = stand.X_WH.q().toRotationMatrix();
    by.block<3, 3>(3 * i, 3) = -Mat3::Identity();
    apart.segment<3>(3 * i) = R_WC * stand.X_CT.p() - stand.X_WH.p();
  }
  const VectorXd places = by.colPivHouseholderQr().solve(apart);
  return {{Quat(R_WC), Vec3(places.tail<3>())}, {Quat(R_HT), Vec3(places.head<3>())}};
}

// Unknowns: rotation and position of C in W about and along W's axes, then those of T in H along H's axes.
PosePair moved(const PosePair& at, const VectorXd& by) {
  const Pose<'W', 'C'>& c = at.X_WC;
  const Pose<'H', 'T'>& t = at.X_HT;
  return {{(turn_by(by.segment<3>(0)) * c.q()).normalized(), Vec3(c.p() + by.segment<3>(3))},
          {(turn_by(by.segment<3>(6)) * t.q()).normalized(), Vec3(t.p() + by.segment<3>(9))}};
}

// Residuals, measured minus expected: position of the tool in C, then its rotation, stand by stand.
VectorXd left_over(std::span<const EyeStand> stands, const PosePair& at) {
  const auto n = static_cast<Eigen::Index>(stands.size());
  VectorXd left(6 * n);
  const Pose<'C', 'W'> X_CW = at.X_WC.inverse();
  for (Eigen::Index i = 0; i < n; ++i) {
    const EyeStand& stand = stands[static_cast<std::size_t>(i)];
    const Pose<'C', 'T'> expected = X_CW * stand.X_WH * at.X_HT;
    left.segment<3>(3 * i) = stand.X_CT.p() - expected.p();
    left.segment<3>(3 * (n + i)) = turn_of(stand.X_CT.q() * expected.q().conjugate());
  }
  return left;
}

MatrixXd slopes(std::span<const EyeStand> stands, const PosePair& at) {
  constexpr double kStep = 1e-6;  // rad and m
  MatrixXd by(6 * static_cast<Eigen::Index>(stands.size()), kPoseUnknowns);
  for (Eigen::Index k = 0; k < kPoseUnknowns; ++k) {
    VectorXd step = VectorXd::Zero(kPoseUnknowns);
    step(k) = kStep;
    const VectorXd ahead = left_over(stands, moved(at, step)), behind = left_over(stands, moved(at, -step));
    by.col(k) = (behind - ahead) / (2.0 * kStep);  // derivative of the expected value
  }
  return by;
}

// m and rad, along and about each axis of C: a tracker measures less accurately along its view.
struct Scatter {
  Vec3 place, turn;
};
// Positions determine up to nine of the twelve unknowns: three for each of their axes.
double freedom_of(Eigen::Index stands) { return static_cast<double>(stands) - 3.0; }
Scatter scatter_of(const VectorXd& left) {
  const Eigen::Index n = left.size() / 6;
  const auto rms = [&](Eigen::Index from, double least) {
    Vec3 squares = Vec3::Zero();
    for (Eigen::Index i = 0; i < n; ++i) squares += left.segment<3>(from + 3 * i).cwiseAbs2();
    return Vec3((squares / freedom_of(n)).cwiseSqrt().cwiseMax(least));
  };
  return {rms(0, kExactPlace), rms(3 * n, kExactTurn)};
}

VectorXd weights_of(const Scatter& scatter, Eigen::Index rows) {
  VectorXd weights(rows);
  weights.head(rows / 2) = scatter.place.cwiseInverse().replicate(rows / 6, 1);
  weights.tail(rows / 2) = scatter.turn.cwiseInverse().replicate(rows / 6, 1);
  return weights;
}

bool settled(const Scatter& now, const Scatter& before) {
  constexpr double kShare = 1e-9;
  return ((now.place - before.place).array().abs() <= kShare * before.place.array()).all() &&
         ((now.turn - before.turn).array().abs() <= kShare * before.turn.array()).all();
}

// Both positions absorb a tracker's scale error, so only their residuals show it. Their scatter is known once
// the scale is removed.
void check_scale(std::span<const EyeStand> stands, const PosePair& at, const VectorXd& left) {
  const auto n = static_cast<Eigen::Index>(stands.size());
  MatrixXd by(6 * n, kPoseUnknowns + 1);
  by.leftCols(kPoseUnknowns) = slopes(stands, at);
  by.col(kPoseUnknowns).setZero();
  const Pose<'C', 'W'> X_CW = at.X_WC.inverse();
  for (Eigen::Index i = 0; i < n; ++i)
    by.block<3, 1>(3 * i, kPoseUnknowns) = (X_CW * stands[static_cast<std::size_t>(i)].X_WH * at.X_HT).p();
  double scale = 0.0, sure = kUnset;
  VectorXd rest = left;
  for (int round = 0; round < 2; ++round) {
    const VectorXd weights = weights_of(scatter_of(rest), left.size());
    const MatrixXd weighed = weights.asDiagonal() * by;
    const MatrixXd inverse = (weighed.transpose() * weighed).inverse();
    const VectorXd found = inverse * (weighed.transpose() * weights.cwiseProduct(left));
    scale = found(kPoseUnknowns);
    sure = kScaleSure * std::sqrt(inverse(kPoseUnknowns, kPoseUnknowns));
    rest = left - by * found;
  }
  if (std::abs(scale) > kScaleOff && std::abs(scale) > sure)
    throw Error(
        fmt::format("the tracker's lengths are {:.2f} +- {:.2f} % larger than the machine's; expected "
                    "at most {:g} %; see to the tracker's calibration and unit, to the markers of the "
                    "tool, and to rig.manipulator.geometry",
                    100.0 * scale, 100.0 * sure, 100.0 * kScaleOff));
}

// Least squares over position and rotation, with the scatter of both from the residuals.
PosePair best_fit(std::span<const EyeStand> stands) {
  PosePair at = first_guess(stands);
  Scatter scatter = scatter_of(left_over(stands, at));
  constexpr int kRounds = 50;
  for (int round = 0; round < kRounds; ++round) {
    const VectorXd left = left_over(stands, at), weights = weights_of(scatter, left.size());
    const MatrixXd by = weights.asDiagonal() * slopes(stands, at);
    const VectorXd step = by.colPivHouseholderQr().solve(VectorXd(weights.cwiseProduct(left)));
    at = moved(at, step);
    const Scatter before = scatter;
    scatter = scatter_of(left_over(stands, at));
    if (step.norm() < 1e-12 && settled(scatter, before)) break;
  }
  return at;
}

// Sets poses, tip and their intervals. inverse: of the normal equations; reach: Student's t.
void set_poses(const PosePair& at, const MatrixXd& inverse, double reach, HandEyeFit& fit) {
  fit.X_WC = at.X_WC;
  fit.X_HT = at.X_HT;
  const VectorXd half = reach * inverse.diagonal().cwiseSqrt();
  fit.turn_half = half.segment<3>(0);
  fit.place_half = half.segment<3>(3);
  // A point at W's origin maps to R_WC p + p_WC. A rotation moves it by -p_WC x turn, and a shift of C's
  // position compensates that.
  Eigen::Matrix<double, 3, 6> to_origin;
  to_origin << cross_matrix(Vec3(at.X_WC.p())), Mat3::Identity();
  const Mat3 origin = to_origin * inverse.topLeftCorner<6, 6>() * to_origin.transpose();
  fit.origin_half = reach * origin.diagonal().cwiseSqrt();
  // Tip in T: R_TH (-p_HT); a rotation of T about H's axes moves it by R_TH (turn x p).
  const Mat3 R_TH = at.X_HT.q().conjugate().toRotationMatrix();
  fit.tip.value = at.X_HT.inverse().p();
  Eigen::Matrix<double, 3, 6> to_tip;
  to_tip << -R_TH * cross_matrix(Vec3(at.X_HT.p())), -R_TH;
  const Mat3 tip = to_tip * inverse.bottomRightCorner<6, 6>() * to_tip.transpose();
  fit.tip.half = reach * tip.diagonal().cwiseSqrt();
}

// Sets the sizes of the residuals, and refuses large ones.
void set_left_over(const VectorXd& left, HandEyeFit& fit) {
  const Eigen::Index n = left.size() / 6;
  fit.rms = std::sqrt(left.head(3 * n).squaredNorm() / static_cast<double>(n));
  fit.rms_turn = std::sqrt(left.tail(3 * n).squaredNorm() / static_cast<double>(n));
  fit.most = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) fit.most = std::max(fit.most, left.segment<3>(3 * i).norm());
  if (!(fit.rms <= kMostLeftPlace) || !(fit.rms_turn <= kMostLeftTurn))
    throw Error(fmt::format(
        "tracker and machine do not tell the same motion: {:.3g} mm and {:.3g} degrees rms are "
        "left over; expected at most {:g} and {:.1f}; see that the jaws hold the tool, that the "
        "machine and not the tracker moves, and to units and axes of both",
        fit.rms * 1e3, fit.rms_turn * 180.0 / M_PI, kMostLeftPlace * 1e3, kMostLeftTurn * 180.0 / M_PI));
}

}  // namespace

HandEyeFit fit_hand_eye(std::span<const EyeStand> stands) {
  if (stands.size() < kFewestSeen)
    throw Error(
        fmt::format("the tool was seen in {} stands of the machine; expected {} or more; see that "
                    "the tracker sees it in all poses",
                    stands.size(), kFewestSeen));
  check_turns(stands);
  const PosePair at = best_fit(stands);
  const VectorXd left = left_over(stands, at);
  const MatrixXd by = weights_of(scatter_of(left), left.size()).asDiagonal() * slopes(stands, at);
  const MatrixXd inverse = (by.transpose() * by).inverse();
  const double reach = student(freedom_of(static_cast<Eigen::Index>(stands.size())), kNormal99);
  HandEyeFit fit;
  set_poses(at, inverse, reach, fit);
  set_left_over(left, fit);
  check_scale(stands, at, left);
  return fit;
}

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Eigen::Index kWeightUnknowns = 7;  // turn, mass, zero
constexpr std::size_t kFewestWeighed = 6;    // stands
constexpr double kAxisOff = 0.2;             // accepted error of a sensor axis with right sign and unit
constexpr double kSure = 4.0;                // standard deviations
constexpr double kMostLeftForce = 0.2;       // N rms: drift and noise of a sensor are far smaller

// The direction of weight in H, times g.
Vec3 weight_per_kg(const WeightStand& stand) {
  return stand.X_WH.q().conjugate() * Vec3(0.0, 0.0, -kStandardGravity);
}

struct Estimate {
  Mat3 R_FH = Mat3::Identity();
  double mass = kUnset;
  Vec3 zero{0, 0, 0};
};

// The side components of the weight's direction vary about zero and the third hardly changes. So the slopes
// of the force over both sides are the first two columns of m R_FH; the third column is at right angles to
// them.
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

// Inputs of the fit: stands, and the time at which the zero is requested.
struct Log {
  std::span<const WeightStand> stands;
  double end;
};

// Covariance of one axis over all stands: independent errors and a random walk of the zero, which is 0 at the
// end. ratio: variance of the walk per s over that of a stand's mean.
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

struct FitSolution {
  Estimate at;
  MatrixXd inverse;                                              // inverse of the normal matrix
  double variance = kUnset;                                      // variance of a stand's mean
  double likelihood = -std::numeric_limits<double>::infinity();  // restricted, logarithm
  double ratio = 0.0;
};

// The rows of each axis are together, so that one triangular matrix whitens every axis.
struct Whitening {
  MatrixXd by;
  VectorXd left;
};
Whitening whitened(std::span<const WeightStand> stands, const Estimate& at,
                   const Eigen::LLT<MatrixXd>& root) {
  const auto n = static_cast<Eigen::Index>(stands.size());
  Whitening w{MatrixXd::Zero(3 * n, kWeightUnknowns), VectorXd(3 * n)};
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

FitSolution solved(const Log& log, Estimate at, double ratio) {
  const std::span<const WeightStand> stands = log.stands;
  const Eigen::LLT<MatrixXd> root(covariance(log, ratio));
  FitSolution result;
  result.ratio = ratio;
  constexpr int kRounds = 20;
  Whitening w = whitened(stands, at, root);
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
  constexpr double kExact = 1e-18;  // N^2: residual of an error-free sensor
  result.at = at;
  result.inverse = normal.inverse();
  result.variance = std::max(kExact, w.left.squaredNorm() / freedom);
  const double spread = 2.0 * MatrixXd(root.matrixL()).diagonal().array().log().sum();
  const double known = std::log(std::max(normal.determinant(), std::numeric_limits<double>::min()));
  result.likelihood = -0.5 * (freedom * std::log(result.variance) + 3.0 * spread + known);
  return result;
}

FitSolution best_of(const Log& log, const Estimate& guess) {
  FitSolution best = solved(log, guess, 0.0);
  for (int i = -16; i <= 16; ++i) {
    const FitSolution one = solved(log, guess, std::pow(10.0, 0.25 * i));
    if (one.likelihood > best.likelihood) best = one;
  }
  return best;
}

// Slope of each sensor axis over its expected reading: 1 if sign and unit are right. A rotation and a zero
// can compensate a wrong axis, except for its change with the weight along it.
struct AxisSlope {
  double value = kUnset, deviation = kUnset;
};
AxisSlope slope_of(const Log& log, const FitSolution& found, Eigen::Index axis) {
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

void check_axes(const Log& log, const FitSolution& found) {
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

// torque(i) = middle x weight(i) + its zero: a linear problem.
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
  const FitSolution found = best_of(log, first_guess(stands));
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
