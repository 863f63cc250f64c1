#include "core/machine/chain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace enc::chain {
namespace {

// Where the links are: each joint's place and axis, and the link's orientation behind it, in R.
struct Placed {
  std::array<Vec3, kMostJoints> joint, axis;
  std::array<Mat3, kMostJoints> R;
  std::size_t count = 0;

  // Of a point that is fixed to link `last`.
  [[nodiscard]] Vec3 point(std::size_t last, const Vec3& p) const { return joint[last] + R[last] * p; }
};

Placed place(const ArmMachine& machine, const PerJoint& q) {
  Placed placed;
  placed.count = std::min(machine.links.size(), kMostJoints);
  Mat3 R = Mat3::Identity();
  Vec3 at = Vec3::Zero();
  for (std::size_t i = 0; i < placed.count; ++i) {
    const ChainLink& link = machine.links[i];
    at += R * link.origin;
    placed.axis[i] = R * link.axis;
    if (link.kind == JointKind::slide)
      at += q[i] * placed.axis[i];
    else
      R *= Eigen::AngleAxisd(q[i], link.axis).toRotationMatrix();
    placed.joint[i] = at;
    placed.R[i] = R;
  }
  return placed;
}

// d p / d q of a point p of link `last`.
Mat3 moves(const ArmMachine& machine, const Placed& placed, std::size_t last, const Vec3& p) {
  Mat3 J = Mat3::Zero();
  for (std::size_t i = 0; i <= last; ++i)
    J.col(static_cast<int>(i)) = machine.links[i].kind == JointKind::slide
                                     ? placed.axis[i]
                                     : Vec3(placed.axis[i].cross(p - placed.joint[i]));
  return J;
}

// d omega / d q of link `last`.
Mat3 turns(const ArmMachine& machine, const Placed& placed, std::size_t last) {
  Mat3 J = Mat3::Zero();
  for (std::size_t i = 0; i <= last; ++i)
    if (machine.links[i].kind == JointKind::hinge) J.col(static_cast<int>(i)) = placed.axis[i];
  return J;
}

// Levenberg-Marquardt whose damping is the squared distance [Sugihara 2011]: far away it is careful, near
// the end it is Newton's. Kept within the limits.
bool search(const ArmMachine& machine, const Vec3& p, PerJoint& q) {
  constexpr double kThere = 1e-10;  // m
  for (int step = 0; step < 60; ++step) {
    const Placed placed = place(machine, q);
    const Vec3 at = placed.point(placed.count - 1, machine.tip);
    const Vec3 apart = p - at;
    if (!std::isfinite(apart.squaredNorm())) return false;
    if (apart.norm() < kThere) return true;
    const Mat3 J = moves(machine, placed, placed.count - 1, at);
    // A machine with fewer joints than ways goes to where it is nearest.
    if (placed.count < kMostJoints && (J.transpose() * apart).norm() < 1e-2 * kThere) return true;
    Mat3 gram = J.transpose() * J;
    gram.diagonal().array() += apart.squaredNorm() + 1e-12;
    const Vec3 change = gram.inverse() * (J.transpose() * apart);
    for (std::size_t i = 0; i < placed.count; ++i)
      q[i] = std::clamp(q[i] + change(static_cast<int>(i)), machine.drives[i].low, machine.drives[i].high);
  }
  return false;
}

}  // namespace

Vec3 tip(const ArmMachine& machine, const PerJoint& q) noexcept {
  const Placed placed = place(machine, q);
  return placed.point(placed.count - 1, machine.tip);
}

Mat3 jacobian(const ArmMachine& machine, const PerJoint& q) noexcept {
  const Placed placed = place(machine, q);
  const std::size_t last = placed.count - 1;
  return moves(machine, placed, last, placed.point(last, machine.tip));
}

bool inverse(const ArmMachine& machine, const Vec3& p, PerJoint& q) noexcept {
  const std::size_t joints = std::min(machine.links.size(), kMostJoints);
  // From where the caller is; then from the quarters of the limits, one for each way to fold. The nearest of
  // what is found counts: a machine with few joints may end where it is only nearer than round about.
  constexpr double kThere = 1e-9;  // m
  double least = std::numeric_limits<double>::infinity();
  PerJoint best = q;
  for (std::size_t start = 0; start <= std::size_t{1} << joints && least > kThere; ++start) {
    PerJoint trial = q;
    for (std::size_t i = 0; i < joints; ++i) {
      const ArmDrive& drive = machine.drives[i];
      const double share = ((start - 1) >> i & 1U) != 0 ? 0.75 : 0.25;
      const double from =
          start == 0 && std::isfinite(q[i]) ? q[i] : drive.low + share * (drive.high - drive.low);
      trial[i] = std::clamp(from, drive.low, drive.high);
    }
    if (!search(machine, p, trial)) continue;
    const double apart = (tip(machine, trial) - p).norm();
    if (apart >= least) continue;
    least = apart;
    best = trial;
  }
  if (!std::isfinite(least)) return false;
  q = best;
  return true;
}

PerJoint gravity(const ArmMachine& machine, const PerJoint& q, double payload) noexcept {
  const Placed placed = place(machine, q);
  const std::size_t last = placed.count - 1;
  // Each mass is lifted by d z / d q.
  Vec3 torque = payload * moves(machine, placed, last, placed.point(last, machine.tip)).row(2).transpose();
  for (std::size_t i = 0; i <= last; ++i) {
    const ChainLink& link = machine.links[i];
    torque += link.mass * moves(machine, placed, i, placed.point(i, link.centre)).row(2).transpose();
  }
  torque *= kStandardGravity;
  return {torque.x(), torque.y(), torque.z()};
}

Mat3 mass(const ArmMachine& machine, const PerJoint& q, double payload) noexcept {
  const Placed placed = place(machine, q);
  const std::size_t last = placed.count - 1;
  const Mat3 tip_moves = moves(machine, placed, last, placed.point(last, machine.tip));
  Mat3 M = payload * tip_moves.transpose() * tip_moves;
  for (std::size_t i = 0; i <= last; ++i) {
    const ChainLink& link = machine.links[i];
    const Mat3 linear = moves(machine, placed, i, placed.point(i, link.centre));
    const Mat3 angular = placed.R[i].transpose() * turns(machine, placed, i);  // in the link's axes
    M += link.mass * linear.transpose() * linear + angular.transpose() * link.inertia.asDiagonal() * angular;
  }
  return M;
}

}  // namespace enc::chain
