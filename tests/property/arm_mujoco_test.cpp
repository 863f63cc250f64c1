// The arm against MuJoCo: the same machine body by body, its statics and inertia by MuJoCo's own algorithms.
// What the parallelogram ties together is put together by projection on the arm's joints.
#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/machine/arm.h"
#include "tests/property/arm_bodies.h"

namespace enc::sim {
namespace {

using test::Built;
using test::Draw;
using test::phantom;
using test::twin;
using test::vector;
using Twin = test::ArmTwin;
using test::chain;

struct Apart {
  double gravity = 0.0;  // N m
  double mass = 0.0;     // of the matrix, relative
};
Apart apart(const Arm& arm, const PerJoint& q, double payload, const Vec3& gravity, const Mat3& mass) {
  const PerJoint ours = arm.gravity(q, payload, Payload::exact);
  return {(gravity - vector(ours)).cwiseAbs().maxCoeff(), (mass - arm.mass(q, payload)).norm() / mass.norm()};
}
Apart compare(const Arm& arm, Built& built, const PerJoint& q, double payload) {
  const mjModel* m = built.physics.model();
  mjData* d = built.physics.data();
  Eigen::Map<Eigen::VectorXd>(d->qpos, m->nq) = built.G * vector(q);
  mj_forward(m, d);
  const Vec3 gravity = built.G.transpose() * Eigen::Map<Eigen::VectorXd>(d->qfrc_bias, m->nv);
  std::vector<double> full(static_cast<std::size_t>(m->nv * m->nv));
  mj_fullM(m, d, full.data());
  const Mat3 M = built.G.transpose() * Eigen::Map<Eigen::MatrixXd>(full.data(), m->nv, m->nv) * built.G;
  return apart(arm, q, payload, gravity, M);
}
Apart compare(const Arm& arm, Twin& twin, const PerJoint& q, double payload) {
  const mjModel* m = twin.physics.model();
  mjData* d = twin.physics.data();
  twin.body.put(d, q, {});
  mj_forward(m, d);
  EXPECT_LT((twin.body.tip(d).e() - Vec3(0.1, -0.2, 0.3) - arm.tip(q).e()).norm(), 1e-12);
  return apart(arm, q, payload, vector(twin.body.load(d)), twin.body.mass(m, d));
}

// Worst over poses.
template <class Bodies>
Apart worst_over_poses(const Arm& arm, Bodies bodies, int poses, double payload, Draw& draw) {
  Apart worst;
  for (int i = 0; i < poses; ++i) {
    const Apart at = compare(arm, bodies, draw.pose(arm), payload);
    worst.gravity = std::max(worst.gravity, at.gravity);
    worst.mass = std::max(worst.mass, at.mass);
  }
  return worst;
}
Apart of_bodies(const ArmMachine& machine, int poses, double payload, Draw& draw) {
  const Arm arm(machine);
  return worst_over_poses(
      arm, machine.kind == ArmKind::phantom ? phantom(arm.machine(), payload) : chain(arm.machine(), payload),
      poses, payload, draw);
}
Apart of_twin(const ArmMachine& machine, int poses, double payload, Draw& draw) {
  const Arm arm(machine);
  return worst_over_poses(arm, twin(arm.machine(), payload), poses, payload, draw);
}

TEST(ArmMujoco, GravityAndMassOfThePhantom) {
  Draw draw;
  const Apart worst = of_bodies(ArmMachine{}, 1'000, 0.020, draw);
  RecordProperty("gravity_Nm", std::to_string(1e15 * worst.gravity) + "e-15");
  RecordProperty("mass_relative", std::to_string(1e15 * worst.mass) + "e-15");
  EXPECT_LT(worst.gravity, 1e-12);
  EXPECT_LT(worst.mass, 1e-9);
}

// Masses, each with its inertia, and the forearm's length off by up to 20 %.
ArmMachine off_by_twenty_percent(Draw& draw) {
  ArmMachine machine;
  PhantomGeometry& g = machine.phantom;
  const auto scale = [&](double& mass, Vec3& inertia) {
    const double off = draw.uniform(0.8, 1.2);
    mass *= off;
    inertia *= off;
  };
  scale(g.m_a, g.I_a);
  scale(g.m_c, g.I_c);
  scale(g.m_be, g.I_be);
  scale(g.m_df, g.I_df);
  g.l2 *= draw.uniform(0.8, 1.2);
  return machine;
}

TEST(ArmMujoco, WithMassesAndForearmOffByTwentyPercent) {
  Draw draw;
  for (int i = 0; i < 50; ++i) {
    const Apart worst = of_bodies(off_by_twenty_percent(draw), 20, draw.uniform(0.0, 0.05), draw);
    EXPECT_LT(worst.gravity, 1e-12) << i;
    EXPECT_LT(worst.mass, 1e-9) << i;
  }
}

TEST(ArmMujoco, TheTwinIsTheSamePhantom) {
  Draw draw;
  const Apart worst = of_twin(ArmMachine{}, 1'000, 0.020, draw);
  RecordProperty("gravity_Nm", std::to_string(1e15 * worst.gravity) + "e-15");
  RecordProperty("mass_relative", std::to_string(1e15 * worst.mass) + "e-15");
  EXPECT_LT(worst.gravity, 1e-12);
  EXPECT_LT(worst.mass, 1e-9);
  for (int i = 0; i < 50; ++i) {
    ArmTruth truth;
    truth.machine = off_by_twenty_percent(draw);
    truth.mass_scale = draw.uniform(0.8, 1.2);
    const Apart off = of_twin(true_machine(truth), 20, draw.uniform(0.0, 0.05), draw);
    EXPECT_LT(off.gravity, 1e-12) << i;
    EXPECT_LT(off.mass, 1e-9) << i;
  }
}

// A crank's motor on the axis, and on the forearm's side of it: the forearm has to weigh more, not less.
TEST(ArmMujoco, TheTwinOfAHeavyForearm) {
  Draw draw;
  for (const double l6 : {0.0, -0.035}) {
    ArmMachine machine;
    machine.phantom.l6 = l6;
    const Apart off = of_twin(machine, 100, 0.0, draw);
    EXPECT_LT(off.gravity, 1e-12) << l6;
    EXPECT_LT(off.mass, 1e-9) << l6;
  }
}

TEST(ArmMujoco, GravityAndMassOfChains) {
  Draw draw;
  for (int i = 0; i < 200; ++i) {
    ArmMachine machine;
    machine.kind = ArmKind::chain;
    for (int k = 0; k <= i % 3; ++k)
      machine.links.push_back({"link", draw.uniform(0, 1) < 0.5 ? JointKind::slide : JointKind::hinge,
                               draw.direction(), 0.2 * draw.direction(), draw.uniform(0.01, 0.5),
                               0.1 * draw.direction(), 1e-4 * Vec3(1.0, draw.uniform(0.8, 1.2), 1.1)});
    machine.tip = 0.1 * draw.direction();
    const double payload = draw.uniform(0.0, 0.05);
    for (const Apart& worst : {of_bodies(machine, 5, payload, draw), of_twin(machine, 5, payload, draw)}) {
      EXPECT_LT(worst.gravity, 1e-9) << i;
      EXPECT_LT(worst.mass, 1e-9) << i;
    }
  }
}

}  // namespace
}  // namespace enc::sim
