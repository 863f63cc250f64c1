#include "sim/hand/hand_plan.h"

#include <cmath>

namespace enc::sim {
namespace {

Vec3 at_most(const Vec3& v, double most) {
  const double norm = v.norm();
  return norm > most ? Vec3(v * (most / norm)) : v;
}

}  // namespace

// The corrected target: a drag into the surface within 45 degrees of its normal counts as along the normal.
Vec3 SteeredPlan::meant() const {
  if (!touched) return to.e();
  const Vec3 n = normal.e(), way = (to - anchor).e();
  const double depth = -n.dot(way);
  if (depth <= 0.0) return to.e();
  const Vec3 aside = way + depth * n;
  const double far = aside.norm();
  const double slides = far > depth ? 1.0 - depth / far : 0.0;
  return anchor.e() - depth * n + slides * aside;
}

HandPlan SteeredPlan::advance(double h, const Point<'W'>& tip, bool touching, double stiffness,
                              double integral_time) {
  apart = touching ? 0.0 : apart + h;
  if (dot(tip - anchor, normal) > kLeft || apart > kApart) touched = false;
  // A critically damped second-order follower with limits on speed and acceleration.
  const Vec3 before = velocity.e();
  const Vec3 wanted = at_most(0.5 * kRate * (meant() - at.e()), kFastest);
  const Vec3 acceleration = at_most(2.0 * kRate * (wanted - before), kQuickest);
  velocity = Vec<'W'>(Vec3(before + h * acceleration));
  at = at + Vec<'W'>(Vec3(h * velocity.e()));
  const Vec3 pushed = touching ? Vec3(beyond.e() + (h / integral_time) * (at - tip).e())
                               : Vec3(std::exp(-h / integral_time) * beyond.e());
  beyond = Vec<'W'>(at_most(pushed, kStrongest / stiffness));
  return {at.e() + beyond.e(), velocity.e(), acceleration};
}

}  // namespace enc::sim
