#include "core/control/task/impedance/impedance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "core/control/task/impedance/impedance_spec.h"

namespace enc {
namespace {

// Rises from 0 to 1 over `width` beyond `from`, smooth at both ends; a step if the width is 0.
double gradually(double depth, double from, double width) {
  if (!(width > 0.0)) return depth >= from ? 1.0 : 0.0;
  const double s = std::clamp((depth - from) / width, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

// Three springs in series: each force k (d - sunk) takes over gradually from the one before.
RenderedStiffness button_at(const InteractionSpec& button, double resistance, double depth) {
  // The bottom's spring begins where it carries the force that is already present at d2.
  const double board = button.bottom * (1.0 - button.after / button.floor);
  const double triggered = gradually(depth, button.trigger, button.gradual);
  const double bottomed = gradually(depth, button.bottom, button.gradual);
  const double above = resistance + triggered * (button.after - resistance);
  const double stiffness = above + bottomed * (button.floor - above);
  return {stiffness, bottomed * button.floor * board / stiffness};
}

}  // namespace

double corner_frequency(double a, double dt) {
  // |H|^2 = a^2 / (a^2 + 2 (1 + a) (1 - cos w dt)) for y = (a x + y_before) / (1 + a): half at this cosine.
  const double cosine = 1.0 - a * a / (2.0 * (1.0 + a));
  return cosine > -1.0 ? std::acos(cosine) / (2.0 * std::numbers::pi * dt)
                       : 0.5 / dt;  // no frequency is reduced below half
}

Mat3 gain_matrix(const Vec3& normal, double across, double along) {
  return across * Mat3::Identity() + (along - across) * (normal * normal.transpose());
}

RenderedStiffness felt_at(const InteractionSpec& interaction, double stiffness, double free, double depth) {
  const double touched = gradually(depth, 0.0, interaction.gradual);
  const double first = free + touched * (stiffness - free);
  if (interaction.kind == Interaction::click) return button_at(interaction, first, depth);
  return {first, 0.0};
}

namespace {

// `D`: viscous damping of the joints; `inverse`: of the mass matrix.
certificate::Directions directions_at(const Mat3& J, const Mat3& inverse, const Mat3& D, const Vec3& normal) {
  const Vec3 across = normal.unitOrthogonal();
  Mat3 axes;
  axes << normal.transpose(), across.transpose(), normal.cross(across).transpose();
  const Mat3 tip = axes * J;
  const Eigen::SelfAdjointEigenSolver<Mat3> mobility(tip * inverse * tip.transpose());
  certificate::Directions found;
  Mat3 back = Mat3::Zero();  // tip force for eta''
  for (int i = 2; i >= 0 && mobility.eigenvalues()(i) > MeetSpec::kLeastMobility; --i) {
    const double root = std::sqrt(mobility.eigenvalues()(i));
    found.moves.col(found.count) = root * mobility.eigenvectors().col(i);
    back.col(found.count++) = mobility.eigenvectors().col(i) / root;
  }
  const Mat3 rates = inverse * tip.transpose() * back;
  found.damping = rates.transpose() * D * rates;
  // A single direction along the normal has no sides.
  if (found.count == 1 && found.moves.col(0).tail<2>().norm() < 1e-9 * found.moves.col(0).norm()) return {};
  return found;
}

}  // namespace

double damping_at(const Impedance& law, double mass) {
  return law.rig.damping * std::sqrt(std::clamp(mass / law.home_mass, 1.0, MeetSpec::kMostMassRatio));
}

ArmLoopAt loop_at(const Impedance& law, const certificate::Hand& hand, double dt, const PerJoint& q,
                  const Vec<'R'>& way, double stiffness, Interaction kind) {
  const Mat3 J = law.arm.jacobian(q), M = law.arm.mass(q, law.prop_mass);
  ArmLoopAt at;
  at.loop.mass = law.arm.felt_mass(J, M, way);
  at.loop.period = dt;
  at.loop.hand = hand;
  at.asked.stiffness = stiffness;
  const double damping = damping_at(law, law.arm.felt_mass(J, M));
  if (kind != Interaction::hit) {
    at.loop.filter = law.filter_gain;
    at.asked.damper.ratio = damping / law.rig.stiffness;
  }
  if (!law.rig.loop) return at;
  const ArmLoop& known = *law.rig.loop;
  const auto n = static_cast<Eigen::Index>(law.arm.joints());
  Mat3 whole = Mat3::Identity();  // missing joints do not move: their columns of J are 0
  whole.topLeftCorner(n, n) = M.topLeftCorner(n, n);
  const Mat3 inverse = whole.inverse();
  const Vec3 rates = at.loop.mass * (inverse * (J.transpose() * way.e()));
  Mat3 viscous = Mat3::Zero();
  at.loop.damping = at.steps.friction = at.steps.encoder = 0.0;
  for (std::size_t i = 0; i < law.arm.joints(); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    const double rate = std::abs(rates(joint));
    const double count = 2.0 * std::numbers::pi / (known.counts[i] * law.rig.machine.drives[i].ratio);
    viscous(joint, joint) = known.viscous[i];
    at.loop.damping += rate * rate * known.viscous[i];
    at.steps.friction += rate * known.friction[i];
    at.steps.encoder += std::abs(J.col(joint).dot(way.e())) * count;
  }
  at.loop.around = directions_at(J, inverse, viscous, way.e());
  at.loop.around.stiffness = law.rig.stiffness;
  at.loop.around.damper = damping;
  at.loop.around.filter = law.filter_gain;
  at.loop.around.alike = kind == Interaction::passive;
  at.loop.delay = known.delay;
  at.loop.ticks = std::max(1, static_cast<int>(std::lround(known.velocity_window / dt)));
  return at;
}

}  // namespace enc
