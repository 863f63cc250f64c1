#include <algorithm>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "core/machine/arm.h"

namespace enc {
namespace {

Vec3 vec(const PerJoint& q) { return {q[0], q[1], q[2]}; }

// Draws PHANToMs with lengths, masses and inertias off by up to 20 %, and poses within their limits.
struct Draw {
  std::mt19937_64 random{1};
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  double off() { return uniform(0.8, 1.2); }
  Vec3 off3() { return {off(), off(), off()}; }

  ArmMachine phantom() {
    ArmMachine m;
    PhantomGeometry& g = m.phantom;
    for (double* number : {&g.l1, &g.l2, &g.l3, &g.l5, &g.l6, &g.m_a, &g.m_c, &g.m_be, &g.m_df, &g.I_base})
      *number *= off();
    for (Vec3* inertia : {&g.I_a, &g.I_c, &g.I_be, &g.I_df}) *inertia = inertia->cwiseProduct(off3());
    return m;
  }
  PerJoint pose(const Arm& arm) {
    PerJoint q{};
    do {
      for (std::size_t i = 0; i < arm.joints(); ++i)
        q[i] = uniform(arm.machine().drives[i].low, arm.machine().drives[i].high);
    } while (!arm.within_limits(q));
    return q;
  }
  Vec3 direction() {
    std::normal_distribution<double> normal;
    return Vec3(normal(random), normal(random), normal(random)).normalized();
  }
  ArmMachine chain() {
    ArmMachine m;
    m.kind = ArmKind::chain;
    const auto joints = std::uniform_int_distribution<int>(1, 3)(random);
    for (int i = 0; i < joints; ++i)
      m.links.push_back({"link", uniform(0, 1) < 0.5 ? JointKind::slide : JointKind::hinge, direction(),
                         uniform(0.05, 0.2) * direction(), uniform(0.01, 0.5),
                         uniform(0.0, 0.1) * direction(), 1e-4 * off3()});
    m.tip = 0.1 * direction();
    for (ArmDrive& drive : m.drives) drive = {-1.0, 1.2, uniform(5, 10), 1e-6};
    return m;
  }
};

TEST(ArmProperty, InverseAfterForwardIsTheSamePlace) {
  Draw draw;
  double worst = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    const Arm arm{i % 2 == 0 ? ArmMachine{} : draw.phantom()};
    const Point<'R'> p = arm.tip(draw.pose(arm));
    PerJoint q{};
    ASSERT_TRUE(arm.inverse(p, q)) << i;
    ASSERT_TRUE(arm.within_limits(q)) << i;
    worst = std::max(worst, (arm.tip(q) - p).norm());
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(ArmProperty, AChainFindsItsWayBack) {
  Draw draw;
  int found = 0;
  for (int i = 0; i < 2'000; ++i) {
    const Arm arm{draw.chain()};
    const Point<'R'> p = arm.tip(draw.pose(arm));
    PerJoint q{};
    if (!arm.inverse(p, q)) continue;
    ASSERT_TRUE(arm.within_limits(q)) << i;
    // The search with fewer than three joints may end in a local minimum.
    const double apart = (arm.tip(q) - p).norm();
    if (arm.joints() == kMostJoints) {
      ASSERT_LT(apart, 1e-9) << i;
    }
    if (apart < 1e-9) ++found;
  }
  RecordProperty("found", found);
  EXPECT_GE(found, 1'990);  // a search, not a closed form: it may get stuck at limits
}

TEST(ArmProperty, TheJacobianIsTheSlopeOfTheTip) {
  Draw draw;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 20'000; ++i) {
    const Arm arm{i % 2 == 0 ? draw.phantom() : draw.chain()};
    const PerJoint q = draw.pose(arm);
    const Mat3 J = arm.jacobian(q);
    for (std::size_t j = 0; j < kMostJoints; ++j) {
      PerJoint above = q, below = q;
      above[j] += kStep;
      below[j] -= kStep;
      const Vec3 slope = (arm.tip(above) - arm.tip(below)).e() / (2.0 * kStep);
      ASSERT_LT((slope - J.col(static_cast<int>(j))).norm(), 1e-9) << i << ' ' << j;
    }
  }
}

// Eq. 4 as printed: the body Jacobian is J in the axes of the end-effector, and R^T F the force in them.
TEST(ArmProperty, TheBodyFormOfEquation4IsTheSame) {
  Draw draw;
  for (int i = 0; i < 10'000; ++i) {
    const Arm arm{draw.phantom()};
    const PerJoint q = draw.pose(arm);
    const Mat3 J = arm.jacobian(q);
    const Mat3 R =
        (Eigen::AngleAxisd(q[0], Vec3::UnitZ()) * Eigen::AngleAxisd(q[2], -Vec3::UnitY())).toRotationMatrix();
    const Vec<'R'> force(Vec3(8.0 * draw.direction()));
    const Mat3 body = R.transpose() * J;
    const Vec3 torque = body.transpose() * (R.transpose() * force.e());
    ASSERT_LT((torque - vec(arm.torque(J, force))).norm(), 1e-14) << i;
    if (arm.dexterity(J) < 0.05) continue;
    const Vec<'R'> back = arm.force(J, arm.torque(J, force));
    ASSERT_LT((back - force).norm(), 1e-10) << i;
  }
}

// The inverse has no step where the damping begins, and the damping bounds it.
TEST(ArmProperty, TheDampedInverseIsBoundedAndContinuous) {
  Draw draw;
  const Arm arm{ArmMachine{}};
  Vec3 before = Vec3::Zero();
  double largest = 0.0, jump = 0.0;
  for (int i = 0; i <= 40'000; ++i) {  // through q2 - q3 = 90 deg
    const double angle = (80.0 + 20.0 * i / 40'000) * M_PI / 180.0;
    const Vec3 force = arm.force(arm.jacobian({0.3, angle, 0.0}), {0.01, 0.02, 0.03}).e();
    ASSERT_TRUE(force.allFinite()) << i;
    largest = std::max(largest, force.norm());
    if (i > 0) jump = std::max(jump, (force - before).norm());
    before = force;
  }
  // |tau| / sigma where the damping begins: 0.0374 / (0.05 * 0.1797).
  EXPECT_LT(largest, 4.2);
  EXPECT_LT(jump, 0.01);
}

// Potential energy of the five bodies and the prop, from their places.
double potential(const PhantomGeometry& g, const PerJoint& q, double payload) {
  const double up = std::sin(q[1]), down = -std::cos(q[2]);  // heights along upper arm and forearm
  return kStandardGravity *
         (g.m_a * (g.l1 * up + 0.5 * g.l2 * down) + g.m_c * (0.5 * g.l1 * up + g.l3 * down) +
          g.m_be * g.l5 * up - g.m_df * g.l6 * down + payload * (g.l1 * up + g.l2 * down));
}

TEST(ArmProperty, GravityIsTheSlopeOfThePotentialEnergy) {
  Draw draw;
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 10'000; ++i) {
    const Arm arm{draw.phantom()};
    const PerJoint q = draw.pose(arm);
    const double payload = draw.uniform(0.0, 0.05);
    const PerJoint torque = arm.gravity(q, payload, Payload::exact);
    for (std::size_t j = 0; j < 3; ++j) {
      PerJoint above = q, below = q;
      above[j] += kStep;
      below[j] -= kStep;
      const PhantomGeometry& g = arm.machine().phantom;
      const double slope = (potential(g, above, payload) - potential(g, below, payload)) / (2.0 * kStep);
      ASSERT_NEAR(torque[j], slope, 1e-9) << i << ' ' << j;
    }
  }
}

// Kinetic energy of a moving body from its mass, velocity, inertia about its centre of mass and spin.
double energy(double mass, const Vec3& velocity, const Vec3& inertia, const Mat3& axes, const Vec3& spin) {
  const Vec3 own = axes.transpose() * spin;
  return 0.5 * mass * velocity.squaredNorm() + 0.5 * own.dot(inertia.cwiseProduct(own));
}

// Kinetic energy of the whole PHANToM, body by body; each joint passes on its velocity.
double kinetic(const Arm& arm, const PerJoint& q, const Vec3& rate, double payload) {
  const PhantomGeometry& g = arm.machine().phantom;
  const Mat3 turret = Eigen::AngleAxisd(q[0], Vec3::UnitZ()).toRotationMatrix();
  const Vec3 axis = -turret.col(1);  // axis of q2 and q3: both lift bodies that point forwards
  const Vec3 upper = Eigen::AngleAxisd(q[1], axis) * turret.col(0);
  const Vec3 fore = Eigen::AngleAxisd(q[2], axis) * -Vec3::UnitZ();
  const Vec3 spin = rate[0] * Vec3::UnitZ();
  const Vec3 spin2 = spin + rate[1] * axis, spin3 = spin + rate[2] * axis;
  // x along the joints' axis; z along be and c, y along a and df.
  const auto axes = [&](const Vec3& y, const Vec3& z) { return (Mat3() << axis, y, z).finished(); };
  const Mat3 along2 = axes(upper.cross(axis), upper), along3 = axes(fore, axis.cross(fore));
  // Moves an inertia published about the origin of R to the centre of mass, l along the body.
  const auto centred = [](Vec3 inertia, double mass, double l, int body_axis) {
    for (int k = 0; k < 3; ++k)
      if (k != body_axis) inertia[k] -= mass * l * l;
    return inertia;
  };
  const Vec3 elbow = g.l1 * spin2.cross(upper);
  double sum = 0.5 * g.I_base * rate[0] * rate[0];
  sum += energy(g.m_be, g.l5 * spin2.cross(upper), centred(g.I_be, g.m_be, g.l5, 2), along2, spin2);
  sum += energy(g.m_df, -g.l6 * spin3.cross(fore), centred(g.I_df, g.m_df, g.l6, 1), along3, spin3);
  sum += energy(g.m_a, elbow + 0.5 * g.l2 * spin3.cross(fore), g.I_a, along3, spin3);
  sum += energy(g.m_c, g.l3 * spin3.cross(fore) + 0.5 * g.l1 * spin2.cross(upper), g.I_c, along2, spin2);
  sum += 0.5 * payload * (elbow + g.l2 * spin3.cross(fore)).squaredNorm();
  for (std::size_t i = 0; i < 3; ++i) {
    const ArmDrive& drive = arm.machine().drives[i];
    const double rotor = drive.ratio * rate[static_cast<int>(i)];
    sum += 0.5 * drive.rotor_inertia * rotor * rotor;
  }
  return sum;
}

TEST(ArmProperty, TheMassMatrixIsTheKineticEnergyOfTheBodies) {
  Draw draw;
  for (int i = 0; i < 10'000; ++i) {
    const Arm arm{draw.phantom()};
    const PerJoint q = draw.pose(arm);
    const double payload = draw.uniform(0.0, 0.05);
    const Mat3 M = arm.mass(q, payload);
    ASSERT_LT((M - M.transpose()).norm(), 1e-18) << i;
    ASSERT_GT(Eigen::SelfAdjointEigenSolver<Mat3>(M).eigenvalues().minCoeff(), 0.0) << i;
    const Vec3 rate = 10.0 * draw.direction();
    const double expected = kinetic(arm, q, rate, payload);
    ASSERT_NEAR(0.5 * rate.dot(M * rate), expected, 1e-9 * expected) << i;
  }
}

// Computes the chain from a row of transforms. It shares only the meaning of ChainLink with the code.
Eigen::Isometry3d link_pose(const ArmMachine& m, const PerJoint& q, std::size_t last) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i <= last; ++i) {
    X = X * Eigen::Translation3d(m.links[i].origin);
    if (m.links[i].kind == JointKind::slide)
      X = X * Eigen::Translation3d(q[i] * m.links[i].axis);
    else
      X = X * Eigen::AngleAxisd(q[i], m.links[i].axis);
  }
  return X;
}

struct Energies {
  double potential = 0.0, kinetic = 0.0;
};
// Energies of the chain that moves at `rate`, by differences of its transforms.
Energies energies(const Arm& arm, const PerJoint& q, const Vec3& rate, double payload) {
  constexpr double kStep = 1e-5;
  const ArmMachine& m = arm.machine();
  PerJoint above = q, below = q;
  for (std::size_t i = 0; i < arm.joints(); ++i) {
    above[i] += kStep * rate[static_cast<int>(i)];
    below[i] -= kStep * rate[static_cast<int>(i)];
  }
  Energies sum;
  const auto add_point = [&](std::size_t last, const Vec3& p, double mass) {
    const Vec3 way = link_pose(m, above, last) * p - link_pose(m, below, last) * p;
    sum.kinetic += 0.5 * mass * (way / (2.0 * kStep)).squaredNorm();
    sum.potential += kStandardGravity * mass * (link_pose(m, q, last) * p).z();
  };
  for (std::size_t i = 0; i < arm.joints(); ++i) {
    const ChainLink& link = m.links[i];
    add_point(i, link.centre, link.mass);
    const Mat3 turn = link_pose(m, below, i).linear().transpose() * link_pose(m, above, i).linear();
    const Eigen::AngleAxisd between(turn);
    const Vec3 spin = between.angle() / (2.0 * kStep) * between.axis();  // in the link's axes
    sum.kinetic += 0.5 * spin.dot(link.inertia.cwiseProduct(spin));
    const double rotor = m.drives[i].ratio * rate[static_cast<int>(i)];
    sum.kinetic += 0.5 * m.drives[i].rotor_inertia * rotor * rotor;
  }
  add_point(arm.joints() - 1, m.tip, payload);
  return sum;
}

TEST(ArmProperty, AChainIsItsTransforms) {
  Draw draw;
  for (int i = 0; i < 5'000; ++i) {
    const Arm arm{draw.chain()};
    const PerJoint q = draw.pose(arm);
    const double payload = draw.uniform(0.0, 0.05);
    const Vec3 tip = link_pose(arm.machine(), q, arm.joints() - 1) * arm.machine().tip;
    ASSERT_LT((arm.tip(q).e() - tip).norm(), 1e-14) << i;
    Vec3 rate = Vec3::Zero();
    for (std::size_t j = 0; j < arm.joints(); ++j) rate[static_cast<int>(j)] = draw.uniform(-1.0, 1.0);
    const double expected = energies(arm, q, rate, payload).kinetic;
    ASSERT_NEAR(0.5 * rate.dot(arm.mass(q, payload) * rate), expected, 1e-6 * expected) << i;
    const PerJoint torque = arm.gravity(q, payload, Payload::exact);
    for (std::size_t j = 0; j < kMostJoints; ++j) {
      PerJoint above = q, below = q;
      above[j] += 1e-5;
      below[j] -= 1e-5;
      const double slope =
          (energies(arm, above, rate, payload).potential - energies(arm, below, rate, payload).potential) /
          2e-5;
      ASSERT_NEAR(torque[j], slope, 1e-8) << i << ' ' << j;
    }
  }
}

}  // namespace
}  // namespace enc
