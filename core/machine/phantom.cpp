#include "core/machine/phantom.h"

#include <cmath>

namespace enc::phantom {
namespace {

// How far from the turret's axis the tip is, m; negative where the arm leans over backwards.
double reach(const PhantomGeometry& g, const PerJoint& q) {
  return g.l1 * std::cos(q[1]) + g.l2 * std::sin(q[2]);
}

}  // namespace

Vec3 tip(const PhantomGeometry& g, const PerJoint& q) noexcept {
  const double r = reach(g, q);
  return {std::cos(q[0]) * r, std::sin(q[0]) * r, g.l1 * std::sin(q[1]) - g.l2 * std::cos(q[2])};
}

Mat3 jacobian(const PhantomGeometry& g, const PerJoint& q) noexcept {
  const double c1 = std::cos(q[0]), s1 = std::sin(q[0]);
  const double c2 = std::cos(q[1]), s2 = std::sin(q[1]);
  const double c3 = std::cos(q[2]), s3 = std::sin(q[2]);
  const double r = g.l1 * c2 + g.l2 * s3;
  Mat3 J;
  J << -s1 * r, -g.l1 * c1 * s2, g.l2 * c1 * c3,  //
      c1 * r, -g.l1 * s1 * s2, g.l2 * s1 * c3,    //
      0.0, g.l1 * c2, g.l2 * s3;
  return J;
}

bool inverse(const PhantomGeometry& g, const Vec3& p, bool ahead, PerJoint& q) noexcept {
  const double side = ahead ? 1.0 : -1.0;
  const double r = side * std::hypot(p.x(), p.y());
  const double square = p.squaredNorm();
  const double least = g.l1 - g.l2, most = g.l1 + g.l2;
  const double slack = 1e-12 * most * most;  // what rounding may push out of a stretched arm's reach
  if (!(square <= most * most + slack && square >= least * least - slack && square > slack)) return false;
  const auto angle = [](double cosine) { return std::acos(std::fmin(1.0, std::fmax(-1.0, cosine))); };
  const double straight = std::sqrt(square);
  const double lift = (g.l1 * g.l1 + square - g.l2 * g.l2) / (2.0 * g.l1 * straight);
  const double fold = (g.l1 * g.l1 + g.l2 * g.l2 - square) / (2.0 * g.l1 * g.l2);
  const double q2 = std::remainder(angle(lift) + std::atan2(p.z(), r), 2.0 * M_PI);
  q = {std::atan2(side * p.y(), side * p.x()), q2, q2 - M_PI / 2.0 + angle(fold)};
  return true;
}

PerJoint gravity(const PhantomGeometry& g, const PerJoint& q, double payload, Payload form) noexcept {
  // On its way to the tip the forearm's half counts; what hangs at the tip counts in full.
  const double m_a = g.m_a + (form == Payload::published ? payload : 0.0);
  const double at_tip = form == Payload::exact ? payload : 0.0;
  const double second = (m_a + at_tip + 0.5 * g.m_c) * g.l1 + g.m_be * g.l5;
  const double third = (0.5 * m_a + at_tip) * g.l2 + g.m_c * g.l3 - g.m_df * g.l6;
  return {0.0, kStandardGravity * second * std::cos(q[1]), kStandardGravity * third * std::sin(q[2])};
}

Mat3 mass(const PhantomGeometry& g, const PerJoint& q, double payload) noexcept {
  const double c2 = std::cos(q[1]), s2 = std::sin(q[1]);
  const double c3 = std::cos(q[2]), s3 = std::sin(q[2]);
  // Forearm and link c as if their masses were at their middles; be and df turn about the origin of R.
  const double elbow = g.m_a + 0.25 * g.m_c;  // mass that moves as the elbow does
  const double crank = 0.25 * g.m_a * g.l2 * g.l2 + g.m_c * g.l3 * g.l3;
  const double both = 0.5 * g.l1 * (g.m_a * g.l2 + g.m_c * g.l3);  // couples upper arm and forearm
  const double turning = g.I_base + elbow * g.l1 * g.l1 * c2 * c2 + crank * s3 * s3 + 2.0 * both * c2 * s3 +
                         (g.I_be.y() + g.I_c.y()) * c2 * c2 + (g.I_be.z() + g.I_c.z()) * s2 * s2 +
                         (g.I_a.y() + g.I_df.y()) * c3 * c3 + (g.I_a.z() + g.I_df.z()) * s3 * s3;
  const double between = -both * std::sin(q[1] - q[2]);
  Mat3 M;
  M << turning, 0.0, 0.0,                                          //
      0.0, g.I_be.x() + g.I_c.x() + elbow * g.l1 * g.l1, between,  //
      0.0, between, g.I_a.x() + g.I_df.x() + crank;
  const Mat3 J = jacobian(g, q);
  return M + payload * J.transpose() * J;
}

}  // namespace enc::phantom
