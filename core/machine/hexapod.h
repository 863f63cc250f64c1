// A six-strut parallel machine: geometry, inverse and forward kinematics, Jacobian, and what it can do.
// Geometry is data (default: H-840).
#pragma once

#include <array>
#include <optional>

#include "core/base/frames.h"

namespace enc {

// Base joints at radius base_radius on angles k*120 deg -/+ base_half_angle, platform joints on k*120 + 60
// +/- platform_half_angle; strut 2k joins base k*120+base_half to platform k*120+60-platform_half. Joint
// planes are `height` apart at zero; the haptic-tip H is `tip_height` above the platform joint plane. The
// origin of R is the centre of the base joint plane. Source: sources/hexapod 2 (derived from the catalogue
// travels and the workspace of [VHMR 2]).
struct HexapodGeometry {
  double base_radius = 0.140;
  double platform_radius = 0.098;
  double base_half_angle = 22.6 * M_PI / 180.0;
  double platform_half_angle = 17.2 * M_PI / 180.0;
  double height = 0.1545;
  // 30 mm to the catalogue's pivot, and above it 160 mm of sensor, gripper and tip.
  double tip_height = 0.190;
  double stroke = 0.0236;  // half stroke of a strut, +/-
  double tilt_limit = 15.0 * M_PI / 180.0;
  double yaw_limit = 30.0 * M_PI / 180.0;
};

// The limit that makes a pose unreachable, if any.
enum class ReachLimit { none, stroke, tilt, yaw };

class Hexapod {
 public:
  explicit Hexapod(const HexapodGeometry& geometry);

  using Lengths = Eigen::Matrix<double, 6, 1>;
  using Jacobian = Eigen::Matrix<double, 6, 6>;  // d length / d (v_H in R, omega in R): m/s per (m/s, rad/s)

  [[nodiscard]] const HexapodGeometry& geometry() const { return geometry_; }
  [[nodiscard]] Pose<'R', 'H'> zero() const {
    return Pose<'R', 'H'>::shift(0, 0, geometry_.height + geometry_.tip_height);
  }
  [[nodiscard]] double zero_length() const { return zero_length_; }
  [[nodiscard]] const Vec3& base_joint(int leg) const {
    return base_[static_cast<std::size_t>(leg)];
  }  // in R
  [[nodiscard]] const Vec3& platform_joint(int leg) const {
    return platform_[static_cast<std::size_t>(leg)];
  }  // in H

  [[nodiscard]] Lengths inverse(const Pose<'R', 'H'>& X_RH) const noexcept;
  [[nodiscard]] Jacobian jacobian(const Pose<'R', 'H'>& X_RH) const noexcept;
  // Newton iteration from `guess` until the lengths agree to `tolerance`, m. Empty if it does not converge in
  // 20 steps.
  struct Solution {
    Pose<'R', 'H'> X_RH;
    int steps = 0;
  };
  [[nodiscard]] std::optional<Solution> forward(const Lengths& lengths, const Pose<'R', 'H'>& guess,
                                                double tolerance = 1e-12) const noexcept;
  [[nodiscard]] ReachLimit limit(const Pose<'R', 'H'>& X_RH) const noexcept;

 private:
  [[nodiscard]] Lengths lengths(const Mat3& R, const Vec3& p) const noexcept;

  HexapodGeometry geometry_;
  std::array<Vec3, 6> base_, platform_;
  double zero_length_ = 0.0;
  double least_upright_ = -1.0;  // cosine of the tilt limit
};

// The parts below the haptic-tip: bodies of revolution about H's z axis, each from its depth below H down to
// the next one. They obstruct a tool that comes from below.
struct Mount {
  double stem_radius = 0.0;                               // starts at H, m
  double gripper_depth = kUnset, gripper_radius = 0.0;    // m
  double platform_depth = kUnset, platform_radius = 0.0;  // m
};

struct Reach {
  double speed = kUnset;         // tip speed, m/s [VHMR 2]
  double acceleration = kUnset;  // tip acceleration, m/s^2
  Hexapod machine{HexapodGeometry{}};
  Mount mount{};

  [[nodiscard]] bool contains(const Pose<'R', 'H'>& X_RH) const noexcept {
    return machine.limit(X_RH) == ReachLimit::none;
  }
};

// The farthest reachable pose on the straight path to the wanted one, for a device that limits its commands
// in this way.
[[nodiscard]] inline Pose<'R', 'H'> clamped(const Reach& reach, const Pose<'R', 'H'>& from,
                                            const Pose<'R', 'H'>& wanted) noexcept {
  if (reach.contains(wanted)) return wanted;
  Pose<'R', 'H'> best = from;
  double low = 0.0, high = 1.0;  // shares of the path
  for (int i = 0; i < 30; ++i) {
    const double share = 0.5 * (low + high);
    const Pose<'R', 'H'> between(from.q().slerp(share, wanted.q()),
                                 Vec3(from.p() + share * (wanted.p() - from.p())));
    const bool reached = reach.contains(between);
    if (reached) best = between;
    (reached ? low : high) = share;
  }
  return best;
}

}  // namespace enc
