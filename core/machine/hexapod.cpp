#include "core/machine/hexapod.h"

#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace enc {

Hexapod::Hexapod(const HexapodGeometry& geometry) : geometry_(geometry) {
  constexpr double kThird = 2.0 * std::numbers::pi / 3.0;
  const auto on_circle = [](double radius, double angle, double z) {
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int k = 0; k < 3; ++k) {
    const auto even = static_cast<std::size_t>(2 * k);
    const double middle = k * kThird + kThird / 2.0;
    base_[even] = on_circle(geometry.base_radius, k * kThird + geometry.base_half_angle, 0.0);
    base_[even + 1] = on_circle(geometry.base_radius, (k + 1) * kThird - geometry.base_half_angle, 0.0);
    platform_[even] =
        on_circle(geometry.platform_radius, middle - geometry.platform_half_angle, -geometry.tip_height);
    platform_[even + 1] =
        on_circle(geometry.platform_radius, middle + geometry.platform_half_angle, -geometry.tip_height);
  }
  zero_length_ = inverse(zero())(0);
  least_upright_ = std::cos(geometry.tilt_limit);
}

Hexapod::Lengths Hexapod::lengths(const Mat3& R, const Vec3& p) const noexcept {
  Lengths lengths;
  for (std::size_t i = 0; i < 6; ++i) lengths(static_cast<int>(i)) = (p + R * platform_[i] - base_[i]).norm();
  return lengths;
}

Hexapod::Lengths Hexapod::inverse(const Pose<'R', 'H'>& X_RH) const noexcept {
  return lengths(X_RH.q().toRotationMatrix(), X_RH.p());
}

Hexapod::Jacobian Hexapod::jacobian(const Pose<'R', 'H'>& X_RH) const noexcept {
  const Mat3 R = X_RH.q().toRotationMatrix();
  Jacobian J;
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec3 arm = R * platform_[i];
    const Vec3 along = (X_RH.p() + arm - base_[i]).normalized();
    J.row(static_cast<int>(i)) << along.transpose(), arm.cross(along).transpose();
  }
  return J;
}

std::optional<Hexapod::Solution> Hexapod::forward(const Lengths& lengths, const Pose<'R', 'H'>& guess,
                                                  double tolerance) const noexcept {
  Solution at{guess, 0};
  for (; at.steps <= 20; ++at.steps) {
    const Lengths error = lengths - inverse(at.X_RH);
    if (!error.allFinite()) return std::nullopt;
    if (error.cwiseAbs().maxCoeff() <= tolerance) return at;
    const Eigen::Matrix<double, 6, 1> step = jacobian(at.X_RH).partialPivLu().solve(error);
    const Vec3 turn = step.tail<3>();
    const double angle = turn.norm();
    const Quat dq = angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, turn / angle)) : Quat::Identity();
    at.X_RH = Pose<'R', 'H'>((dq * at.X_RH.q()).normalized(), Vec3(at.X_RH.p() + step.head<3>()));
  }
  return std::nullopt;
}

ReachLimit Hexapod::limit(const Pose<'R', 'H'>& X_RH) const noexcept {
  const Mat3 R = X_RH.q().toRotationMatrix();
  // The comparison makes NaN "not reachable".
  if (!((lengths(R, X_RH.p()).array() - zero_length_).abs().maxCoeff() <= geometry_.stroke))
    return ReachLimit::stroke;
  if (!(R(2, 2) >= least_upright_)) return ReachLimit::tilt;
  if (R(1, 0) == 0.0 && R(0, 0) > 0.0) return ReachLimit::none;  // commands do not turn the tip
  if (!(std::abs(std::atan2(R(1, 0), R(0, 0))) <= geometry_.yaw_limit)) return ReachLimit::yaw;
  return ReachLimit::none;
}

}  // namespace enc
