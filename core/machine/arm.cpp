#include "core/machine/arm.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/base/error.h"
#include "core/machine/chain.h"
#include "core/machine/phantom.h"

namespace enc {
namespace {

constexpr double kNear = 0.05;   // dexterity below which the inverse of eq. 4 is damped
constexpr double kSlack = 1e-9;  // rad or m that rounding may put a joint beyond its limit

void need(bool good, const char* what) {
  if (!good) throw Error(what, "arm");
}

bool positive(double value) { return std::isfinite(value) && value > 0.0; }
bool not_negative(double value) { return std::isfinite(value) && value >= 0.0; }
bool not_negative(const Vec3& v) { return v.allFinite() && v.minCoeff() >= 0.0; }

void check(const PhantomGeometry& g) {
  need(positive(g.l1) && positive(g.l2) && not_negative(g.l3),
       "an arm's length is not positive; expected l1 and l2 above 0 and l3 not below it");
  need(std::isfinite(g.l5) && std::isfinite(g.l6),
       "a centre of mass is not a number; expected l5 and l6 in m");
  need(not_negative(g.m_a) && not_negative(g.m_c) && not_negative(g.m_be) && not_negative(g.m_df),
       "a mass of the arm is negative; expected 0 kg or more");
  need(not_negative(g.I_a) && not_negative(g.I_c) && not_negative(g.I_be) && not_negative(g.I_df) &&
           not_negative(g.I_base),
       "an inertia of the arm is negative; expected 0 kg m^2 or more");
  need(g.coupled_low < g.coupled_high, "the limits of q2 - q3 are the wrong way round; expected low < high");
}

void check(ChainLink& link) {
  const double length = link.axis.norm();
  need(positive(length), "a joint of the chain has no axis; expected a direction that is not 0");
  link.axis /= length;
  need(link.origin.allFinite() && link.centre.allFinite(), "a place of the chain is not a number");
  need(not_negative(link.mass) && not_negative(link.inertia),
       "a mass or inertia of the chain is negative; expected 0 or more");
}

// J^T J of the joints that are there. The others get a diagonal that lies between its least and largest
// eigenvalue (a diagonal element always does), so that these stay what they are.
Mat3 gram(const Mat3& J, std::size_t joints) {
  Mat3 G = J.transpose() * J;
  for (auto i = static_cast<int>(joints); i < 3; ++i) G(i, i) = G(0, 0);
  return G;
}

double dexterity_of(const Mat3& G) {
  const Vec3 squares =
      Eigen::SelfAdjointEigenSolver<Mat3>().computeDirect(G, Eigen::EigenvaluesOnly).eigenvalues();
  return squares(2) > 0.0 ? std::sqrt(std::max(0.0, squares(0)) / squares(2)) : 0.0;
}

}  // namespace

Arm::Arm(const ArmMachine& machine) : machine_(machine) {
  if (machine_.kind == ArmKind::phantom) {
    check(machine_.phantom);
  } else {
    joints_ = machine_.links.size();
    need(joints_ >= 1 && joints_ <= kMostJoints, "a chain has no or too many links; expected 1 to 3");
    need(machine_.tip.allFinite(),
         "the tip of the chain is not a number; expected its place in the last link");
    for (ChainLink& link : machine_.links) check(link);
  }
  for (std::size_t i = 0; i < joints_; ++i) {
    const ArmDrive& drive = machine_.drives[i];
    need(drive.low < drive.high, "a joint's limits are the wrong way round; expected low < high");
    need(positive(drive.ratio) && not_negative(drive.rotor_inertia),
         "a drive has no ratio or a negative rotor; expected a ratio above 0 and 0 kg m^2 or more");
  }
}

Point<'R'> Arm::tip(const PerJoint& q) const noexcept {
  return Point<'R'>(machine_.kind == ArmKind::phantom ? phantom::tip(machine_.phantom, q)
                                                      : chain::tip(machine_, q));
}

Mat3 Arm::jacobian(const PerJoint& q) const noexcept {
  return machine_.kind == ArmKind::phantom ? phantom::jacobian(machine_.phantom, q)
                                           : chain::jacobian(machine_, q);
}

PerJoint Arm::gravity(const PerJoint& q, double payload, Payload form) const noexcept {
  return machine_.kind == ArmKind::phantom ? phantom::gravity(machine_.phantom, q, payload, form)
                                           : chain::gravity(machine_, q, payload);
}

Mat3 Arm::mass(const PerJoint& q, double payload) const noexcept {
  Mat3 M = machine_.kind == ArmKind::phantom ? phantom::mass(machine_.phantom, q, payload)
                                             : chain::mass(machine_, q, payload);
  for (std::size_t i = 0; i < joints_; ++i) {
    const ArmDrive& drive = machine_.drives[i];
    M(static_cast<int>(i), static_cast<int>(i)) += drive.rotor_inertia * drive.ratio * drive.ratio;
  }
  return M;
}

PerJoint Arm::torque(const Mat3& J, const Vec<'R'>& force) const noexcept {
  const Vec3 torque = J.transpose() * force.e();
  return {torque.x(), torque.y(), torque.z()};
}

// Least squares, J (J^T J)^-1 tau, with damping where the pose is nearly singular: there a torque along the
// lost direction becomes a bounded force instead of an infinite one [Nakamura and Hanafusa 1986].
Vec<'R'> Arm::force(const Mat3& J, const PerJoint& torque) const noexcept {
  Mat3 G = gram(J, joints_);
  const double size = G.trace();
  if (!(size > 0.0)) return Vec<'R'>::zero();
  const double near = dexterity_of(G) / kNear;
  if (near < 1.0) G.diagonal().array() += size * kNear * kNear * (1.0 - near * near);
  return Vec<'R'>(Vec3(J * (G.inverse() * Vec3(torque[0], torque[1], torque[2]))));
}

double Arm::felt_mass(const Mat3& J, const Mat3& mass, const Vec<'R'>& way) const noexcept {
  const auto n = static_cast<Eigen::Index>(joints_);
  Mat3 whole = Mat3::Identity();
  whole.topLeftCorner(n, n) = mass.topLeftCorner(n, n);
  const Vec3 row = J.transpose() * way.e();
  // Joints are few, so Cramer's rule is exact enough.
  const double mobility = row.dot(whole.inverse() * row);  // J M^-1 J^T along the way
  return mobility > 1e-6 ? 1.0 / mobility : 0.0;
}

double Arm::felt_mass(const Mat3& J, const Mat3& mass) const noexcept {
  double most = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    most = std::max(most, felt_mass(J, mass, Vec<'R'>(Vec3(Vec3::Unit(axis)))));
  return most;
}

Vec<'R'> Arm::force_to_accelerate(const Mat3& J, const Mat3& mass,
                                  const Vec<'R'>& acceleration) const noexcept {
  constexpr double kDamped = 1e-6;  // m^2: near a singular pose no joint is asked for what it cannot
  const Mat3 squared = J * J.transpose() + kDamped * Mat3::Identity();
  const Vec3 torque = mass * (J.transpose() * (squared.inverse() * acceleration.e()));
  return force(J, {torque(0), torque(1), torque(2)});
}

double Arm::dexterity(const Mat3& J) const noexcept { return dexterity_of(gram(J, joints_)); }

bool Arm::inverse(const Point<'R'>& p, PerJoint& q) const noexcept {
  if (machine_.kind == ArmKind::chain) return chain::inverse(machine_, p.e(), q);
  for (const bool ahead : {true, false}) {
    PerJoint found;
    if (!phantom::inverse(machine_.phantom, p.e(), ahead, found) || !within_limits(found)) continue;
    q = found;
    return true;
  }
  return false;
}

bool Arm::reaches(const Point<'R'>& p, double least_dexterity, PerJoint& q) const noexcept {
  return inverse(p, q) && dexterity(jacobian(q)) >= least_dexterity;
}

bool Arm::within_limits(const PerJoint& q) const noexcept {
  const auto inside = [](double value, double low, double high) {
    return value >= low - kSlack && value <= high + kSlack;
  };
  for (std::size_t i = 0; i < joints_; ++i)
    if (!inside(q[i], machine_.drives[i].low, machine_.drives[i].high)) return false;
  const PhantomGeometry& g = machine_.phantom;
  return machine_.kind != ArmKind::phantom || inside(q[1] - q[2], g.coupled_low, g.coupled_high);
}

}  // namespace enc
