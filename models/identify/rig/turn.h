// Small rotations, for fits of poses.
#pragma once

#include <Eigen/SVD>

#include "core/base/frames.h"

namespace enc::models {

// cross_matrix(a) * b is a x b.
[[nodiscard]] inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

// Rotation about this axis by its length, rad.
[[nodiscard]] inline Quat turn_by(const Vec3& turn) {
  const double angle = turn.norm();
  if (!(angle > 0.0)) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(angle, Vec3(turn / angle)));
}

// The inverse: the axis times the angle, which is at most half a turn.
[[nodiscard]] inline Vec3 turn_of(const Quat& rotation) {
  const Quat q = rotation.w() < 0.0 ? Quat(-rotation.coeffs()) : rotation;
  const double sine = q.vec().norm();
  if (!(sine > 0.0)) return Vec3::Zero();
  return q.vec() * (2.0 * std::atan2(sine, q.w()) / sine);
}

[[nodiscard]] inline Mat3 nearest_rotation(const Mat3& m) {
  const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 flat = svd.matrixU() * svd.matrixV().transpose();
  const Vec3 signs(1.0, 1.0, flat.determinant() < 0.0 ? -1.0 : 1.0);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace enc::models
