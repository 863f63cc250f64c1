// Coordinate frames as types: a chain of poses that does not fit does not compile.
//
// The letters are those of the papers [VHMR Fig 4]:
//   fixed: W world, R base of the machine, S headset server, O object, C tracker camera or left camera of a
//     stereo head, D right camera of a stereo head
//   moving: G headset, L hand tracker, H haptic-tip, F force sensor, N nearest surface point, T tool markers,
//     K wrist of the tracked hand
// Variables keep the monogram: X_WR is the pose of R in W, p_WT a point in W, f_N a force in N.
// Everything is SI. An unset number is NaN, never zero and never identity.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace enc {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

inline constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::string_view kFrames = "WRSOCDGLHFNTK";
template <char A>
concept Frame = kFrames.find(A) != std::string_view::npos;

namespace detail {
// Three numbers in a frame. The storage is plain, because Eigen 3.4 types are not trivially copyable; e() is
// the Eigen view to compute with.
struct Triple {
  std::array<double, 3> xyz{kUnset, kUnset, kUnset};
  Triple() = default;
  Triple(double x, double y, double z) : xyz{x, y, z} {}
  explicit Triple(const Vec3& v) : xyz{v.x(), v.y(), v.z()} {}
  [[nodiscard]] Eigen::Map<const Vec3> e() const { return Eigen::Map<const Vec3>(xyz.data()); }
  [[nodiscard]] Eigen::Map<Vec3> e() { return Eigen::Map<Vec3>(xyz.data()); }
  [[nodiscard]] bool finite() const {
    return std::isfinite(xyz[0]) && std::isfinite(xyz[1]) && std::isfinite(xyz[2]);
  }
};
}  // namespace detail

// A displacement, velocity, force or direction, in the axes of A.
template <char A>
requires Frame<A>
struct Vec : detail::Triple {
  using Triple::Triple;
  static Vec zero() { return Vec(0, 0, 0); }
  [[nodiscard]] double norm() const { return e().norm(); }
  friend Vec operator+(const Vec& a, const Vec& b) { return Vec(Vec3(a.e() + b.e())); }
  friend Vec operator-(const Vec& a, const Vec& b) { return Vec(Vec3(a.e() - b.e())); }
  friend Vec operator-(const Vec& a) { return Vec(Vec3(-a.e())); }
  friend Vec operator*(double s, const Vec& a) { return Vec(Vec3(s * a.e())); }
  friend double dot(const Vec& a, const Vec& b) { return a.e().dot(b.e()); }
};

// A position in A, m.
template <char A>
requires Frame<A>
struct Point : detail::Triple {
  using Triple::Triple;
  friend Vec<A> operator-(const Point& a, const Point& b) { return Vec<A>(Vec3(a.e() - b.e())); }
  friend Point operator+(const Point& p, const Vec<A>& v) { return Point(Vec3(p.e() + v.e())); }
  friend Point operator-(const Point& p, const Vec<A>& v) { return Point(Vec3(p.e() - v.e())); }
};

// The pose of B in A: maps B coordinates to A coordinates. Unit quaternion (x, y, z, w) and origin of B in A,
// m.
template <char A, char B>
requires(Frame<A>&& Frame<B>) struct Pose {
  std::array<double, 4> xyzw{kUnset, kUnset, kUnset, kUnset};
  std::array<double, 3> xyz{kUnset, kUnset, kUnset};

  Pose() = default;
  Pose(const Quat& q, const Vec3& p) : xyzw{q.x(), q.y(), q.z(), q.w()}, xyz{p.x(), p.y(), p.z()} {}
  Pose(const Quat& q, const Point<A>& p) : Pose(q, Vec3(p.e())) {}
  static Pose identity() { return {Quat::Identity(), Vec3(0, 0, 0)}; }
  static Pose shift(double x, double y, double z) { return {Quat::Identity(), Vec3(x, y, z)}; }

  [[nodiscard]] Eigen::Map<const Quat> q() const { return Eigen::Map<const Quat>(xyzw.data()); }
  [[nodiscard]] Eigen::Map<const Vec3> p() const { return Eigen::Map<const Vec3>(xyz.data()); }
  [[nodiscard]] Point<A> origin() const { return Point<A>(Vec3(p())); }
  [[nodiscard]] Pose<B, A> inverse() const {
    const Quat qi = q().conjugate();
    return {qi, Vec3(-(qi * p()))};
  }
  // True if all numbers are finite and the quaternion is a rotation: | |q| - 1 | < 1e-6.
  [[nodiscard]] bool valid() const {
    return p().allFinite() && q().coeffs().allFinite() && std::abs(q().norm() - 1.0) < 1e-6;
  }
};

template <char A, char B, char D>
Pose<A, D> operator*(const Pose<A, B>& X_AB, const Pose<B, D>& X_BD) {
  return {X_AB.q() * X_BD.q(), Vec3(X_AB.q() * X_BD.p() + X_AB.p())};
}
template <char A, char B>
Point<A> operator*(const Pose<A, B>& X_AB, const Point<B>& p_B) {
  return Point<A>(Vec3(X_AB.q() * p_B.e() + X_AB.p()));
}
template <char A, char B>
Vec<A> operator*(const Pose<A, B>& X_AB, const Vec<B>& v_B) {
  return Vec<A>(Vec3(X_AB.q() * v_B.e()));
}
// Refuse a chain that does not fit: X_AB * X_PQ needs B = P.
template <char A, char B, char P, char Q>
requires(B != P) void operator*(const Pose<A, B>&, const Pose<P, Q>&) = delete;

static_assert(std::is_trivially_copyable_v<Pose<'W', 'R'>> && std::is_trivially_copyable_v<Point<'W'>>);

}  // namespace enc
