#include "core/machine/arm.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/base/error.h"

namespace enc {
namespace {

// The PHANToM Premium in closed form: kinematics, statics [VisHap eq. 5] and mass matrix, after Cavusoglu,
// Feygin and Tendick (2002). Angles, lengths and bodies are those of PhantomGeometry.
namespace phantom {

// Distance of the tip from the turret's axis, m; negative if the arm leans over backwards.
double reach(const PhantomGeometry& g, const PerJoint& q) {
  return g.l1 * std::cos(q[1]) + g.l2 * std::sin(q[2]);
}

// The tip in R, m.
Vec3 tip(const PhantomGeometry& g, const PerJoint& q) noexcept {
  const double r = reach(g, q);
  return {std::cos(q[0]) * r, std::sin(q[0]) * r, g.l1 * std::sin(q[1]) - g.l2 * std::cos(q[2])};
}

// d tip / d q
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

// Joints that place the tip at p. Upper arm and forearm fold only one way, q2 - q3 in [-90, 90] deg. `ahead`
// selects one of the two remaining turret angles: the one that faces p, or the one that leans over backwards
// to it. Returns false if p is out of reach.
bool inverse(const PhantomGeometry& g, const Vec3& p, bool ahead, PerJoint& q) noexcept {
  const double side = ahead ? 1.0 : -1.0;
  const double r = side * std::hypot(p.x(), p.y());
  const double square = p.squaredNorm();
  const double least = g.l1 - g.l2, most = g.l1 + g.l2;
  const double slack = 1e-12 * most * most;  // allowance for rounding at a stretched arm's reach
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
  // Half of the forearm's mass counts at the tip; a payload at the tip counts in full.
  const double m_a = g.m_a + (form == Payload::published ? payload : 0.0);
  const double at_tip = form == Payload::exact ? payload : 0.0;
  const double second = (m_a + at_tip + 0.5 * g.m_c) * g.l1 + g.m_be * g.l5;
  const double third = (0.5 * m_a + at_tip) * g.l2 + g.m_c * g.l3 - g.m_df * g.l6;
  return {0.0, kStandardGravity * second * std::cos(q[1]), kStandardGravity * third * std::sin(q[2])};
}

// Excludes the rotors; the payload acts at the tip.
Mat3 mass(const PhantomGeometry& g, const PerJoint& q, double payload) noexcept {
  const double c2 = std::cos(q[1]), s2 = std::sin(q[1]);
  const double c3 = std::cos(q[2]), s3 = std::sin(q[2]);
  // Forearm and link c count as if their masses were at their middles; be and df turn about the origin of R.
  const double elbow = g.m_a + 0.25 * g.m_c;  // mass that moves with the elbow
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

}  // namespace phantom

// A serial chain of hinges and slides (ChainLink): kinematics, statics and mass matrix of an arm that is not
// a PHANToM. It reads ArmMachine::links; Arm ensures 1 to kMostJoints links with unit axes.
namespace chain {

// Poses of the links: position and axis of each joint, and orientation of the link behind it, in R.
struct LinkPoses {
  std::array<Vec3, kMostJoints> joint, axis;
  std::array<Mat3, kMostJoints> R;
  std::size_t count = 0;

  // A point fixed to link `last`, in R.
  [[nodiscard]] Vec3 point(std::size_t last, const Vec3& p) const { return joint[last] + R[last] * p; }
};

LinkPoses place(const ArmMachine& machine, const PerJoint& q) {
  LinkPoses placed;
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

// d p / d q for a point p of link `last`.
Mat3 moves(const ArmMachine& machine, const LinkPoses& placed, std::size_t last, const Vec3& p) {
  Mat3 J = Mat3::Zero();
  for (std::size_t i = 0; i <= last; ++i)
    J.col(static_cast<int>(i)) = machine.links[i].kind == JointKind::slide
                                     ? placed.axis[i]
                                     : Vec3(placed.axis[i].cross(p - placed.joint[i]));
  return J;
}

// d omega / d q for link `last`.
Mat3 turns(const ArmMachine& machine, const LinkPoses& placed, std::size_t last) {
  Mat3 J = Mat3::Zero();
  for (std::size_t i = 0; i <= last; ++i)
    if (machine.links[i].kind == JointKind::hinge) J.col(static_cast<int>(i)) = placed.axis[i];
  return J;
}

// Levenberg-Marquardt method whose damping is the squared distance [Sugihara 2011]: it is careful far away,
// and becomes Newton's method near the end. Stays within the limits.
bool search(const ArmMachine& machine, const Vec3& p, PerJoint& q) {
  constexpr double kThere = 1e-10;  // m
  for (int step = 0; step < 60; ++step) {
    const LinkPoses placed = place(machine, q);
    const Vec3 at = placed.point(placed.count - 1, machine.tip);
    const Vec3 apart = p - at;
    if (!std::isfinite(apart.squaredNorm())) return false;
    if (apart.norm() < kThere) return true;
    const Mat3 J = moves(machine, placed, placed.count - 1, at);
    // A machine with fewer than three joints stops at the nearest point that it can reach.
    if (placed.count < kMostJoints && (J.transpose() * apart).norm() < 1e-2 * kThere) return true;
    Mat3 gram = J.transpose() * J;
    gram.diagonal().array() += apart.squaredNorm() + 1e-12;
    const Vec3 change = gram.inverse() * (J.transpose() * apart);
    for (std::size_t i = 0; i < placed.count; ++i)
      q[i] = std::clamp(q[i] + change(static_cast<int>(i)), machine.drives[i].low, machine.drives[i].high);
  }
  return false;
}

// The tip in R, m.
Vec3 tip(const ArmMachine& machine, const PerJoint& q) noexcept {
  const LinkPoses placed = place(machine, q);
  return placed.point(placed.count - 1, machine.tip);
}

// d tip / d q
Mat3 jacobian(const ArmMachine& machine, const PerJoint& q) noexcept {
  const LinkPoses placed = place(machine, q);
  const std::size_t last = placed.count - 1;
  return moves(machine, placed, last, placed.point(last, machine.tip));
}

// Joints within the drives' limits that place the tip within 1e-9 m of p. With fewer joints than directions,
// they place the tip nearest to p, as far as the search finds it. The search starts from `q` and from
// positions spread over the limits. Returns false and keeps q if no search ends within the limits. Takes at
// most about 0.2 ms.
bool inverse(const ArmMachine& machine, const Vec3& p, PerJoint& q) noexcept {
  const std::size_t joints = std::min(machine.links.size(), kMostJoints);
  // The search starts from the caller's joints, then from the quarters of the limits, one for each way to
  // fold. The nearest result counts, because a machine with few joints may end at a local minimum.
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

// The payload acts at the tip.
PerJoint gravity(const ArmMachine& machine, const PerJoint& q, double payload) noexcept {
  const LinkPoses placed = place(machine, q);
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

// Excludes the rotors.
Mat3 mass(const ArmMachine& machine, const PerJoint& q, double payload) noexcept {
  const LinkPoses placed = place(machine, q);
  const std::size_t last = placed.count - 1;
  const Mat3 tip_moves = moves(machine, placed, last, placed.point(last, machine.tip));
  Mat3 M = payload * tip_moves.transpose() * tip_moves;
  for (std::size_t i = 0; i <= last; ++i) {
    const ChainLink& link = machine.links[i];
    const Mat3 linear = moves(machine, placed, i, placed.point(i, link.centre));
    const Mat3 angular = placed.R[i].transpose() * turns(machine, placed, i);  // along the link's axes
    M += link.mass * linear.transpose() * linear + angular.transpose() * link.inertia.asDiagonal() * angular;
  }
  return M;
}

}  // namespace chain

constexpr double kNear = 0.05;   // dexterity below which the inverse of eq. 4 is damped
constexpr double kSlack = 1e-9;  // rad or m by which rounding may put a joint beyond its limit

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

// J^T J of the existing joints. Missing joints get a diagonal between its least and largest eigenvalue, as
// any diagonal element is, so that these two eigenvalues do not change.
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

// Least squares, J (J^T J)^-1 tau, damped where the pose is nearly singular. There a torque along the lost
// direction becomes a bounded force instead of an infinite one [Nakamura and Hanafusa 1986].
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
  // A machine has few joints, so Cramer's rule is exact enough.
  const double mobility = row.dot(whole.inverse() * row);  // J M^-1 J^T along the direction
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
  constexpr double kDamped = 1e-6;  // m^2: limits joint torques near a singular pose
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
