// The arm against MuJoCo: the same machine, built here body by body, its statics and inertia by MuJoCo's own
// algorithms. Bodies hang on a tree of five hinges (or the chain's joints); what the parallelogram ties
// together is put together by projection on the arm's joints.
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/arm/arm.h"
#include "core/scene_spec.h"
#include "sim/arm/arm_model.h"
#include "sim/mujoco.h"

namespace enc::sim {
namespace {

mjsBody* add_body(mjsBody* parent, const Vec3& at, double mass, const Vec3& centre, const Vec3& inertia) {
  mjsBody* body = mjs_addBody(parent, nullptr);
  std::copy_n(at.data(), 3, body->pos);
  std::copy_n(centre.data(), 3, body->ipos);
  std::copy_n(inertia.data(), 3, body->inertia);
  body->mass = mass;
  body->explicitinertial = true;
  return body;
}

void add_joint(mjsBody* body, mjtJoint type, const Vec3& axis, const ArmDrive* drive = nullptr) {
  mjsJoint* joint = mjs_addJoint(body, nullptr);
  joint->type = type;
  std::copy_n(axis.data(), 3, joint->axis);
  if (drive != nullptr) joint->armature = drive->rotor_inertia * drive->ratio * drive->ratio;
}

void add_payload(mjsBody* link, const Vec3& tip, double mass) {
  if (mass > 0.0) add_body(link, tip, mass, Vec3::Zero(), Vec3::Constant(1e-15));
}

// The physics of an arm and d (MuJoCo's joints) / d (arm's joints).
struct Built {
  Physics physics;
  Eigen::MatrixXd G;
};

SpecPtr empty() {
  SpecPtr spec(mj_makeSpec());
  spec->option.gravity[2] = -kStandardGravity;
  spec->compiler.degree = 0;
  return spec;
}

// Its joints, in MuJoCo's order: q1, q2, q3 - q2 (forearm on upper arm), q3 (crank), q2 - q3 (link on crank).
Built phantom(const ArmMachine& machine, double payload) {
  const PhantomGeometry& g = machine.phantom;
  SpecPtr spec = empty();
  const Vec3 lift(0, -1, 0);
  // Cavusoglu's x, y, z are y, z, x of R at zero.
  const auto turned = [](const Vec3& I) { return Vec3(I.z(), I.x(), I.y()); };
  // be and df are published about the origin of R: here about their centres. As bodies they break A + B >= C;
  // turning about the vertical with the turret, they may borrow from I_base what they lack.
  double I_base = g.I_base;
  const auto body_inertia = [&](const Vec3& I, double mass, const Vec3& centre) {
    Vec3 own = turned(I) - mass * (centre.squaredNorm() * Vec3::Ones() - centre.cwiseProduct(centre));
    const double lack = std::max(0.0, 0.5 * (own.y() - own.x() - own.z()) + 1e-9);
    own += lack * Vec3(1, 0, 1);
    I_base -= lack;
    return own;
  };
  const Vec3 be_centre(g.l5, 0, 0), df_centre(0, 0, g.l6);
  const Vec3 be_inertia = body_inertia(g.I_be, g.m_be, be_centre);
  const Vec3 df_inertia = body_inertia(g.I_df, g.m_df, df_centre);
  mjsBody* world = mjs_findBody(spec.get(), "world");
  mjsBody* turret = add_body(world, {0, 0, 0}, 0.1, {0, 0, 0}, Vec3::Constant(I_base));
  add_joint(turret, mjJNT_HINGE, {0, 0, 1}, &machine.drives[0]);
  mjsBody* be = add_body(turret, {0, 0, 0}, g.m_be, be_centre, be_inertia);
  add_joint(be, mjJNT_HINGE, lift, &machine.drives[1]);
  mjsBody* a = add_body(be, {g.l1, 0, 0}, g.m_a, {0, 0, -0.5 * g.l2}, turned(g.I_a));
  add_joint(a, mjJNT_HINGE, lift);
  add_payload(a, {0, 0, -g.l2}, payload);
  mjsBody* df = add_body(turret, {0, 0, 0}, g.m_df, df_centre, df_inertia);
  add_joint(df, mjJNT_HINGE, lift, &machine.drives[2]);
  mjsBody* c = add_body(df, {0, 0, -g.l3}, g.m_c, {0.5 * g.l1, 0, 0}, turned(g.I_c));
  add_joint(c, mjJNT_HINGE, lift);
  Eigen::MatrixXd G(5, 3);
  G << 1, 0, 0, 0, 1, 0, 0, -1, 1, 0, 0, 1, 0, 1, -1;
  return {Physics(std::move(spec)), G};
}

Built chain(const ArmMachine& machine, double payload) {
  SpecPtr spec = empty();
  mjsBody* body = mjs_findBody(spec.get(), "world");
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    const ChainLink& link = machine.links[i];
    body = add_body(body, link.origin, link.mass, link.centre, link.inertia);
    add_joint(body, link.kind == JointKind::hinge ? mjJNT_HINGE : mjJNT_SLIDE, link.axis, &machine.drives[i]);
  }
  add_payload(body, machine.tip, payload);
  return {Physics(std::move(spec)), Eigen::MatrixXd::Identity(static_cast<int>(machine.links.size()), 3)};
}

// The twin's own model of it, of either kind.
Built twin(const ArmMachine& machine, double payload) {
  SpecPtr spec = empty();
  const ArmTruth truth{};
  PropSpec prop;
  prop.mass = payload;
  build_arm(spec.get(), {machine, truth, &prop, Pose<'W', 'R'>::shift(0.1, -0.2, 0.3)});
  Physics physics(std::move(spec));
  const mjModel* m = physics.model();
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(m->nv, 3);
  const auto row = [&](const char* joint, const Eigen::RowVector3d& of_q) {
    G.row(m->jnt_dofadr[physics.id(mjOBJ_JOINT, joint)]) = of_q;
  };
  row("arm_1", {1, 0, 0});
  if (m->nv > 1) row("arm_2", {0, 1, 0});
  if (m->nv > 2) row("arm_3", {0, 0, 1});
  if (machine.kind == ArmKind::phantom) {
    row("arm_forearm", {0, -1, 1});
    row("arm_link", {0, 1, -1});
  }
  return {std::move(physics), G};
}

struct Apart {
  double gravity = 0.0;  // N m
  double mass = 0.0;     // of the matrix, relative
};
Apart compare(const Arm& arm, Built& built, const PerJoint& q, double payload) {
  const mjModel* m = built.physics.model();
  mjData* d = built.physics.data();
  Eigen::Map<Eigen::VectorXd>(d->qpos, m->nq) = built.G * Vec3(q[0], q[1], q[2]);
  mj_forward(m, d);
  const Vec3 gravity = built.G.transpose() * Eigen::Map<Eigen::VectorXd>(d->qfrc_bias, m->nv);
  std::vector<double> full(static_cast<std::size_t>(m->nv * m->nv));
  mj_fullM(m, d, full.data());
  const Mat3 M = built.G.transpose() * Eigen::Map<Eigen::MatrixXd>(full.data(), m->nv, m->nv) * built.G;
  const PerJoint ours = arm.gravity(q, payload, Payload::exact);
  return {(gravity - Vec3(ours[0], ours[1], ours[2])).cwiseAbs().maxCoeff(),
          (M - arm.mass(q, payload)).norm() / M.norm()};
}

struct Draw {
  std::mt19937_64 random{7};
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  Vec3 direction() {
    std::normal_distribution<double> normal;
    return Vec3(normal(random), normal(random), normal(random)).normalized();
  }
  PerJoint pose(const Arm& arm) {
    PerJoint q{};
    do {
      for (std::size_t i = 0; i < arm.joints(); ++i)
        q[i] = uniform(arm.machine().drives[i].low, arm.machine().drives[i].high);
    } while (!arm.within_limits(q));
    return q;
  }
};

// Worst over poses.
Apart worst_over_poses(const ArmMachine& machine, int poses, double payload, Draw& draw,
                       bool of_twin = false) {
  const Arm arm(machine);
  Built built = of_twin                            ? twin(arm.machine(), payload)
                : machine.kind == ArmKind::phantom ? phantom(arm.machine(), payload)
                                                   : chain(arm.machine(), payload);
  Apart worst;
  for (int i = 0; i < poses; ++i) {
    const Apart apart = compare(arm, built, draw.pose(arm), payload);
    worst.gravity = std::max(worst.gravity, apart.gravity);
    worst.mass = std::max(worst.mass, apart.mass);
  }
  return worst;
}

TEST(ArmMujoco, GravityAndMassOfThePhantom) {
  Draw draw;
  const Apart worst = worst_over_poses(ArmMachine{}, 1'000, 0.020, draw);
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
    const Apart worst = worst_over_poses(off_by_twenty_percent(draw), 20, draw.uniform(0.0, 0.05), draw);
    EXPECT_LT(worst.gravity, 1e-12) << i;
    EXPECT_LT(worst.mass, 1e-9) << i;
  }
}

TEST(ArmMujoco, TheTwinIsTheSamePhantom) {
  Draw draw;
  const Apart worst = worst_over_poses(ArmMachine{}, 1'000, 0.020, draw, true);
  RecordProperty("gravity_Nm", std::to_string(1e15 * worst.gravity) + "e-15");
  RecordProperty("mass_relative", std::to_string(1e15 * worst.mass) + "e-15");
  EXPECT_LT(worst.gravity, 1e-9);
  EXPECT_LT(worst.mass, 0.01);
  for (int i = 0; i < 50; ++i) {
    const Apart off = worst_over_poses(off_by_twenty_percent(draw), 20, draw.uniform(0.0, 0.05), draw, true);
    EXPECT_LT(off.gravity, 1e-9) << i;
    EXPECT_LT(off.mass, 0.01) << i;
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
    const Apart worst = worst_over_poses(machine, 5, draw.uniform(0.0, 0.05), draw);
    EXPECT_LT(worst.gravity, 1e-9) << i;
    EXPECT_LT(worst.mass, 1e-9) << i;
  }
}

}  // namespace
}  // namespace enc::sim
