#include "core/task/meet/arm_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace enc {

double damping_at(const Impedance& law, double mass) {
  return law.rig.damping * std::sqrt(std::clamp(mass / law.home_mass, 1.0, 4.0));
}

ArmLoopAt loop_at(const Impedance& law, const certificate::Hand& hand, double dt, const PerJoint& q,
                  const Vec<'R'>& way, double stiffness, bool hit) {
  const Mat3 J = law.arm.jacobian(q), M = law.arm.mass(q, law.prop_mass);
  ArmLoopAt at;
  at.loop.mass = law.arm.felt_mass(J, M, way);
  at.loop.period = dt;
  at.loop.hand = hand;
  at.asked.stiffness = stiffness;
  if (!hit) {
    at.loop.filter = law.filter_gain;
    at.asked.damper.ratio = damping_at(law, law.arm.felt_mass(J, M)) / law.rig.stiffness;
  }
  if (!law.rig.loop) return at;
  const ArmLoop& known = *law.rig.loop;
  const auto n = static_cast<Eigen::Index>(law.arm.joints());
  Mat3 whole = Mat3::Identity();  // joints that are not there do not move: their columns of J are 0
  whole.topLeftCorner(n, n) = M.topLeftCorner(n, n);
  const Vec3 rates = at.loop.mass * (whole.inverse() * (J.transpose() * way.e()));
  at.loop.damping = at.steps.friction = at.steps.encoder = 0.0;
  for (std::size_t i = 0; i < law.arm.joints(); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    const double rate = std::abs(rates(joint));
    const double count = 2.0 * std::numbers::pi / (known.counts[i] * law.rig.machine.drives[i].ratio);
    at.loop.damping += rate * rate * known.viscous[i];
    at.steps.friction += rate * known.friction[i];
    at.steps.encoder += std::abs(J.col(joint).dot(way.e())) * count;
  }
  at.loop.delay = known.delay;
  at.loop.ticks = std::max(1, static_cast<int>(std::lround(known.velocity_window / dt)));
  return at;
}

}  // namespace enc
