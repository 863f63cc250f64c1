// The arm against MuJoCo, the machine built body by body: statics and inertia by MuJoCo's own algorithms, and
// motion.
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/machine/arm.h"
#include "core/spec/scene_spec.h"
#include "sim/bodies/arm_model.h"
#include "sim/bodies/mujoco.h"

namespace enc::sim {
namespace {

// ---- An arm's machine as bodies of MuJoCo, in two ways: built here body by body, and as the twin models it.

// The physics of an arm, and d (MuJoCo's joints) / d (arm's joints).
struct ArmPhysics {
  sim::Physics physics;
  Eigen::MatrixXd G;
};
// Bodies hang on a tree of five hinges. Its joints, in MuJoCo's order: q1, q2, q3 - q2 (forearm on upper
// arm), q3 (crank), q2 - q3 (link on crank).
ArmPhysics phantom(const ArmMachine& machine, double payload);
ArmPhysics chain(const ArmMachine& machine, double payload);

// The twin's own model of an arm of either kind.
struct ArmTwin {
  sim::Physics physics;
  sim::ArmBody body;
};
ArmTwin twin(const ArmMachine& machine, double payload, const sim::ArmTruth& truth = {});

Vec3 vector(const PerJoint& of) { return {of[0], of[1], of[2]}; }
PerJoint per_joint(const Vec3& of) { return {of.x(), of.y(), of.z()}; }

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

sim::SpecPtr empty() {
  sim::SpecPtr spec(mj_makeSpec());
  spec->option.gravity[2] = -kStandardGravity;
  spec->compiler.degree = 0;
  return spec;
}

ArmPhysics phantom(const ArmMachine& machine, double payload) {
  const PhantomGeometry& g = machine.phantom;
  sim::SpecPtr spec = empty();
  const Vec3 lift(0, -1, 0);
  // Cavusoglu's x, y, z are y, z, x of R at zero.
  const auto turned = [](const Vec3& I) { return Vec3(I.z(), I.x(), I.y()); };
  // The published inertias of be and df are about the origin of R; here they are about their centres. As
  // bodies they break A + B >= C. Turning about the vertical with the turret, they may take the lacking part
  // from I_base.
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
  return {sim::Physics(std::move(spec)), G};
}

ArmPhysics chain(const ArmMachine& machine, double payload) {
  sim::SpecPtr spec = empty();
  mjsBody* body = mjs_findBody(spec.get(), "world");
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    const ChainLink& link = machine.links[i];
    body = add_body(body, link.origin, link.mass, link.centre, link.inertia);
    add_joint(body, link.kind == JointKind::hinge ? mjJNT_HINGE : mjJNT_SLIDE, link.axis, &machine.drives[i]);
  }
  add_payload(body, machine.tip, payload);
  return {sim::Physics(std::move(spec)),
          Eigen::MatrixXd::Identity(static_cast<int>(machine.links.size()), 3)};
}

ArmTwin twin(const ArmMachine& machine, double payload, const sim::ArmTruth& truth) {
  sim::SpecPtr spec = empty();
  spec->option.integrator = mjINT_RK4;
  spec->option.timestep = 0.001;
  PropSpec prop;
  prop.mass = payload;
  sim::build_arm(spec.get(), {machine, truth, &prop, Pose<'W', 'R'>::shift(0.1, -0.2, 0.3)});
  sim::Physics physics(std::move(spec));
  const sim::ArmBody body(physics, Arm(machine).joints());
  return {std::move(physics), body};
}

// ---- The arm against MuJoCo: the machine body by body, its statics and inertia by MuJoCo's own algorithms.
// A projection on the arm's joints closes the parallelogram.

using Twin = ArmTwin;

struct ModelError {
  double gravity = 0.0;  // largest error, N m
  double mass = 0.0;     // largest error of the matrix, relative
};
ModelError apart(const Arm& arm, const PerJoint& q, double payload, const Vec3& gravity, const Mat3& mass) {
  const PerJoint ours = arm.gravity(q, payload, Payload::exact);
  return {(gravity - vector(ours)).cwiseAbs().maxCoeff(), (mass - arm.mass(q, payload)).norm() / mass.norm()};
}
ModelError compare(const Arm& arm, ArmPhysics& built, const PerJoint& q, double payload) {
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
ModelError compare(const Arm& arm, Twin& twin, const PerJoint& q, double payload) {
  const mjModel* m = twin.physics.model();
  mjData* d = twin.physics.data();
  twin.body.put(d, q, {});
  mj_forward(m, d);
  EXPECT_LT((twin.body.tip(d).e() - Vec3(0.1, -0.2, 0.3) - arm.tip(q).e()).norm(), 1e-12);
  return apart(arm, q, payload, vector(twin.body.load(d)), twin.body.mass(m, d));
}

// Computes the worst errors over poses.
template <class Bodies>
ModelError worst_over_poses(const Arm& arm, Bodies bodies, int poses, double payload, Draw& draw) {
  ModelError worst;
  for (int i = 0; i < poses; ++i) {
    const ModelError at = compare(arm, bodies, draw.pose(arm), payload);
    worst.gravity = std::max(worst.gravity, at.gravity);
    worst.mass = std::max(worst.mass, at.mass);
  }
  return worst;
}
ModelError of_bodies(const ArmMachine& machine, int poses, double payload, Draw& draw) {
  const Arm arm(machine);
  return worst_over_poses(
      arm, machine.kind == ArmKind::phantom ? phantom(arm.machine(), payload) : chain(arm.machine(), payload),
      poses, payload, draw);
}
ModelError of_twin(const ArmMachine& machine, int poses, double payload, Draw& draw) {
  const Arm arm(machine);
  return worst_over_poses(arm, twin(arm.machine(), payload), poses, payload, draw);
}

TEST(ArmMujoco, GravityAndMassOfThePhantom) {
  Draw draw;
  const ModelError worst = of_bodies(ArmMachine{}, 1'000, 0.020, draw);
  RecordProperty("gravity_Nm", std::to_string(1e15 * worst.gravity) + "e-15");
  RecordProperty("mass_relative", std::to_string(1e15 * worst.mass) + "e-15");
  EXPECT_LT(worst.gravity, 1e-12);
  EXPECT_LT(worst.mass, 1e-9);
}

// Changes masses, each with its inertia, and the forearm's length by up to 20 %.
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
    const ModelError worst = of_bodies(off_by_twenty_percent(draw), 20, draw.uniform(0.0, 0.05), draw);
    EXPECT_LT(worst.gravity, 1e-12) << i;
    EXPECT_LT(worst.mass, 1e-9) << i;
  }
}

TEST(ArmMujoco, TheTwinIsTheSamePhantom) {
  Draw draw;
  const ModelError worst = of_twin(ArmMachine{}, 1'000, 0.020, draw);
  RecordProperty("gravity_Nm", std::to_string(1e15 * worst.gravity) + "e-15");
  RecordProperty("mass_relative", std::to_string(1e15 * worst.mass) + "e-15");
  EXPECT_LT(worst.gravity, 1e-12);
  EXPECT_LT(worst.mass, 1e-9);
  for (int i = 0; i < 50; ++i) {
    ArmTruth truth;
    truth.machine = off_by_twenty_percent(draw);
    truth.mass_scale = draw.uniform(0.8, 1.2);
    const ModelError off = of_twin(true_machine(truth), 20, draw.uniform(0.0, 0.05), draw);
    EXPECT_LT(off.gravity, 1e-12) << i;
    EXPECT_LT(off.mass, 1e-9) << i;
  }
}

// A crank's motor on the axis, or on the forearm's side of it, requires a heavier forearm, not a lighter one.
TEST(ArmMujoco, TheTwinOfAHeavyForearm) {
  Draw draw;
  for (const double l6 : {0.0, -0.035}) {
    ArmMachine machine;
    machine.phantom.l6 = l6;
    const ModelError off = of_twin(machine, 100, 0.0, draw);
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
    for (const ModelError& worst :
         {of_bodies(machine, 5, payload, draw), of_twin(machine, 5, payload, draw)}) {
      EXPECT_LT(worst.gravity, 1e-9) << i;
      EXPECT_LT(worst.mass, 1e-9) << i;
    }
  }
}

// ---- The twin's arm moves as its bodies do: under inertial forces, driven, stopped, and still within
// friction.

using Twin = ArmTwin;

// A PHANToM without friction, as the twin has it and body by body.
struct Pair {
  Twin own;
  ArmPhysics bodies = phantom(ArmMachine{}, 0.020);

  Pair() : own(twin(ArmMachine{}, 0.020, frictionless())) {
    bodies.physics.model()->opt.enableflags |= mjENBL_ENERGY;
  }
  static ArmTruth frictionless() {
    ArmTruth truth;
    truth.friction = truth.viscous = {};
    return truth;
  }
  // Draws a pose that touches no limit.
  static PerJoint inside(Draw& draw) {
    PerJoint q = draw.pose(Arm(ArmMachine{}));
    for (double& angle : q) angle *= 0.5;
    return q;
  }
  // Sets the bodies to the twin's pose and velocity.
  void follow() {
    const PerJoint q = own.body.joints(own.physics.data()), v = own.body.rates(own.physics.data());
    mjData* d = bodies.physics.data();
    Eigen::Map<Eigen::Matrix<double, 5, 1>>(d->qpos) = bodies.G * vector(q);
    Eigen::Map<Eigen::Matrix<double, 5, 1>>(d->qvel) = bodies.G * vector(v);
    mj_forward(bodies.physics.model(), d);
  }
  [[nodiscard]] double energy() {
    follow();
    return bodies.physics.data()->energy[0] + bodies.physics.data()->energy[1];
  }
};

// Includes the forces between turning joints.
TEST(ArmMujoco, TheTwinIsBentByItsMotionAsTheBodiesAre) {
  Draw draw;
  Pair pair;
  mjData* d = pair.own.physics.data();
  for (int k = 0; k < 300; ++k) {
    const Vec3 v = 5.0 * draw.direction();
    pair.own.body.put(d, draw.pose(Arm(ArmMachine{})), per_joint(v));
    mj_forward(pair.own.physics.model(), d);
    pair.follow();
    const Vec3 bodies = pair.bodies.G.transpose() *
                        Eigen::Map<Eigen::Matrix<double, 5, 1>>(pair.bodies.physics.data()->qfrc_bias);
    EXPECT_LT((vector(pair.own.body.load(d)) - bodies).norm(), 1e-12);
  }
}

// Torques of the motors accelerate the joints as the mass matrix predicts.
TEST(ArmMujoco, TheTwinIsDrivenByItsMotors) {
  Draw draw;
  Pair pair;
  const mjModel* m = pair.own.physics.model();
  mjData* d = pair.own.physics.data();
  for (int k = 0; k < 100; ++k) {
    const Vec3 v = draw.direction(), torque = 0.2 * draw.direction();
    pair.own.body.put(d, Pair::inside(draw), per_joint(v));
    pair.own.body.drive(d, per_joint(torque));
    mj_forward(m, d);
    const Vec3 expected = pair.own.body.mass(m, d).inverse() * (torque - vector(pair.own.body.load(d)));
    EXPECT_LT((vector(pair.own.body.rates(d)) - v).norm(), 1e-15);
    std::copy_n(d->qacc, 3, d->qvel);
    EXPECT_LT((vector(pair.own.body.rates(d)) - expected).norm(), 1e-9 * expected.norm()) << k;
  }
}

// Each motor turns either way from home without weight until it meets a limit, its own or the fold's, and
// stays there.
TEST(ArmMujoco, TheTwinStopsAtItsLimits) {
  const Arm arm{ArmMachine{}};
  const ArmMachine& machine = arm.machine();
  const auto beyond = [&](const PerJoint& q) {  // rad
    double most =
        std::max(q[1] - q[2] - machine.phantom.coupled_high, machine.phantom.coupled_low - (q[1] - q[2]));
    for (std::size_t k = 0; k < 3; ++k)
      most = std::max({most, q[k] - machine.drives[k].high, machine.drives[k].low - q[k]});
    return most;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    for (const double torque : {-0.03, 0.03}) {
      Pair pair;
      mjData* d = pair.own.physics.data();
      pair.own.physics.model()->opt.gravity[2] = 0.0;
      PerJoint push{};
      push[i] = torque;
      double most = -1.0;
      for (int tick = 0; tick < 3'000; ++tick) {
        pair.own.body.drive(d, push);
        ASSERT_TRUE(pair.own.physics.step());
        most = std::max(most, beyond(pair.own.body.joints(d)));
      }
      EXPECT_GT(most, -1e-3) << i;
      EXPECT_LT(most, 0.1) << i;
    }
  }
}

// Oscillations that meet no limit.
TEST(ArmMujoco, TheTwinKeepsTheEnergyOfTheBodies) {
  Draw draw;
  for (int k = 0; k < 20; ++k) {
    Pair pair;
    const Vec3 v = 2.0 * draw.direction();
    pair.own.body.put(pair.own.physics.data(), {0.0, 0.1, 0.1}, per_joint(v));
    const double before = pair.energy(), kinetic = pair.bodies.physics.data()->energy[1];
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(pair.own.physics.step());
    EXPECT_LT(std::abs(pair.energy() - before), 1e-5 * kinetic) << k;
  }
}

// Dry friction holds: under half of it the tip stays within a micrometre in a second, at a time step of 1 ms.
TEST(ArmMujoco, TheTwinDoesNotCreep) {
  Draw draw;
  const Arm arm{ArmMachine{}};
  const ArmTruth truth;
  for (int k = 0; k < 10; ++k) {
    Twin own = twin(ArmMachine{}, 0.020, truth);
    mjData* d = own.physics.data();
    own.physics.model()->opt.gravity[2] = 0.0;
    const PerJoint start = draw.pose(arm);
    own.body.put(d, start, {});
    PerJoint push{};
    for (std::size_t i = 0; i < 3; ++i) push[i] = (k + i) % 2 == 0 ? 0.5 * truth.friction[i] : 0.0;
    own.body.drive(d, push);
    for (int i = 0; i < 1'000; ++i) ASSERT_TRUE(own.physics.step());
    EXPECT_LT((arm.tip(own.body.joints(d)) - arm.tip(start)).norm(), 1e-6) << k;
    for (std::size_t i = 0; i < 3; ++i) push[i] *= 4.0;  // twice the friction: it moves
    own.body.drive(d, push);
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(own.physics.step());
    EXPECT_GT((arm.tip(own.body.joints(d)) - arm.tip(start)).norm(), 1e-3) << k;
  }
}

}  // namespace
}  // namespace enc::sim
