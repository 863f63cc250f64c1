// The twin's arm moves as its bodies do: bent by its motion, driven, stopped, and still where friction holds
// it.
#include <algorithm>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/machine/arm.h"
#include "tests/property/arm_bodies.h"

namespace enc::sim {
namespace {

using test::Built;
using test::Draw;
using test::per_joint;
using test::phantom;
using test::twin;
using test::vector;
using Twin = test::ArmTwin;

// A PHANToM without friction, as the twin has it and body by body.
struct Pair {
  Twin own;
  Built bodies = phantom(ArmMachine{}, 0.020);

  Pair() : own(twin(ArmMachine{}, 0.020, frictionless())) {
    bodies.physics.model()->opt.enableflags |= mjENBL_ENERGY;
  }
  static ArmTruth frictionless() {
    ArmTruth truth;
    truth.friction = truth.viscous = {};
    return truth;
  }
  // A pose that touches no limit.
  static PerJoint inside(Draw& draw) {
    PerJoint q = draw.pose(Arm(ArmMachine{}));
    for (double& angle : q) angle *= 0.5;
    return q;
  }
  // Puts the bodies where the twin is, as fast.
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

// Also what turning joints do to each other.
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

// Torques of the motors accelerate the joints as the mass matrix says.
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

// Each motor, either way, from home, without weight: it comes to a limit, its own or the fold's, and stays
// there.
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

// Swings that meet no limit.
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
    for (std::size_t i = 0; i < 3; ++i) push[i] *= 4.0;  // twice the friction: it does go
    own.body.drive(d, push);
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(own.physics.step());
    EXPECT_GT((arm.tip(own.body.joints(d)) - arm.tip(start)).norm(), 1e-3) << k;
  }
}

}  // namespace
}  // namespace enc::sim
