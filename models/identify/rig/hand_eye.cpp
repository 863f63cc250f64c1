#include "models/identify/rig/hand_eye.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "core/base/error.h"
#include "models/identify/rig/turn.h"

namespace enc::models {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Mat9 = Eigen::Matrix<double, 9, 9>;

constexpr std::size_t kFewestSeen = 12;     // stands: with fewer, intervals were found too narrow
constexpr Eigen::Index kPoseUnknowns = 12;  // place and turn of both poses
constexpr double kLeastSecondTurn = 0.035;  // rad rms about each axis but the best two: 2 degrees
constexpr double kMostLeftPlace = 2e-3;     // m rms
constexpr double kMostLeftTurn = 0.03;      // rad rms
constexpr double kScaleOff = 0.005;         // of a tracker's lengths: a good one is ten times better
constexpr double kScaleSure = 4.0;          // standard deviations
constexpr double kExactPlace = 1e-8, kExactTurn = 1e-9;  // m, rad: no device is better

struct Both {
  Pose<'W', 'C'> X_WC;
  Pose<'H', 'T'> X_HT;
};

// Turns about one axis leave the tool's place along it free: two are needed.
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

Both first_guess(std::span<const EyeStand> stands) {
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

// Unknowns: turn and place of C in W about and along W's axes, then those of T in H along H's axes.
Both moved(const Both& at, const VectorXd& by) {
  const Pose<'W', 'C'>& c = at.X_WC;
  const Pose<'H', 'T'>& t = at.X_HT;
  return {{(turn_by(by.segment<3>(0)) * c.q()).normalized(), Vec3(c.p() + by.segment<3>(3))},
          {(turn_by(by.segment<3>(6)) * t.q()).normalized(), Vec3(t.p() + by.segment<3>(9))}};
}

// Place of the tool in C, then its turn, stand by stand: measured less expected.
VectorXd left_over(std::span<const EyeStand> stands, const Both& at) {
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

MatrixXd slopes(std::span<const EyeStand> stands, const Both& at) {
  constexpr double kStep = 1e-6;  // rad and m
  MatrixXd by(6 * static_cast<Eigen::Index>(stands.size()), kPoseUnknowns);
  for (Eigen::Index k = 0; k < kPoseUnknowns; ++k) {
    VectorXd step = VectorXd::Zero(kPoseUnknowns);
    step(k) = kStep;
    const VectorXd ahead = left_over(stands, moved(at, step)), behind = left_over(stands, moved(at, -step));
    by.col(k) = (behind - ahead) / (2.0 * kStep);  // of what is expected
  }
  return by;
}

// m and rad, along and about each axis of C: a tracker sees worse along its view.
struct Scatter {
  Vec3 place, turn;
};
// Places tell up to nine of the twelve unknowns: of each of their axes three.
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

// A tracker's scale hides in both places, and is seen only in what they leave over; how much that scatters is
// seen when the scale is taken out of it.
void check_scale(std::span<const EyeStand> stands, const Both& at, const VectorXd& left) {
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

}  // namespace

HandEyeFit fit_hand_eye(std::span<const EyeStand> stands) {
  if (stands.size() < kFewestSeen)
    throw Error(
        fmt::format("the tool was seen in {} stands of the machine; expected {} or more; see that "
                    "the tracker sees it in all poses",
                    stands.size(), kFewestSeen));
  check_turns(stands);
  Both at = first_guess(stands);
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
  const VectorXd left = left_over(stands, at);
  const MatrixXd by = weights_of(scatter, left.size()).asDiagonal() * slopes(stands, at);
  const MatrixXd inverse = (by.transpose() * by).inverse();
  const double reach = student(freedom_of(static_cast<Eigen::Index>(stands.size())), kNormal99);

  HandEyeFit fit;
  fit.X_WC = at.X_WC;
  fit.X_HT = at.X_HT;
  const VectorXd half = reach * inverse.diagonal().cwiseSqrt();
  fit.turn_half = half.segment<3>(0);
  fit.place_half = half.segment<3>(3);
  // What is seen at W's origin is at R_WC p + p_WC: it moves by -p_WC x turn, which is what C's place does
  // the other way round.
  Eigen::Matrix<double, 3, 6> to_origin;
  to_origin << cross_matrix(Vec3(at.X_WC.p())), Mat3::Identity();
  const Mat3 origin = to_origin * inverse.topLeftCorner<6, 6>() * to_origin.transpose();
  fit.origin_half = reach * origin.diagonal().cwiseSqrt();
  // Tip in T: R_TH (-p_HT); a turn of T about H's axes moves it by R_TH (turn x p).
  const Mat3 R_TH = at.X_HT.q().conjugate().toRotationMatrix();
  fit.tip.value = at.X_HT.inverse().p();
  Eigen::Matrix<double, 3, 6> to_tip;
  to_tip << -R_TH * cross_matrix(Vec3(at.X_HT.p())), -R_TH;
  const Mat3 tip = to_tip * inverse.bottomRightCorner<6, 6>() * to_tip.transpose();
  fit.tip.half = reach * tip.diagonal().cwiseSqrt();

  const auto n = static_cast<Eigen::Index>(stands.size());
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
  check_scale(stands, at, left);
  return fit;
}

}  // namespace enc::models
