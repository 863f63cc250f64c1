// The arm as bodies of MuJoCo against the closed forms of the core, and what its integrator keeps.
#include <cmath>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "sim/arm/arm_model.h"
#include "sim/random.h"

namespace enc::sim {
namespace {

const PropSpec kPlate{};
const char* const kNames[5] = {"arm_1", "arm_2", "arm_3", "arm_forearm", "arm_link"};

struct Bodies {
  explicit Bodies(const ArmTruth& truth, double timestep = 0.001) : machine(true_machine(truth)) {
    SpecPtr spec(mj_makeSpec());
    spec->option.timestep = timestep;
    spec->option.integrator = mjINT_RK4;
    spec->option.gravity[2] = -9.80665;
    build_arm(spec.get(), {machine, truth, &kPlate, Pose<'W', 'R'>::identity(), false});
    physics = std::make_unique<Physics>(std::move(spec));
    body = std::make_unique<ArmBody>(*physics, 3);
  }
  void put(const PerJoint& q) {
    const double all[5] = {q[0], q[1], q[2], q[2] - q[1], q[1] - q[2]};
    for (int i = 0; i < 5; ++i) physics->data()->qpos[joint(i)] = all[i];
    mju_zero(physics->data()->qvel, 5);
    mj_forward(physics->model(), physics->data());
  }
  [[nodiscard]] int joint(int i) const { return physics->id(mjOBJ_JOINT, kNames[i]); }  // hinges: all alike
  // What the two tied joints do as the three free ones move.
  [[nodiscard]] Eigen::Matrix<double, 5, 3> ties() const {
    Eigen::Matrix<double, 5, 3> B = Eigen::Matrix<double, 5, 3>::Zero();
    for (int i = 0; i < 3; ++i) B(joint(i), i) = 1.0;
    B(joint(3), 2) = B(joint(4), 1) = 1.0;
    B(joint(3), 1) = B(joint(4), 2) = -1.0;
    return B;
  }
  ArmMachine machine;
  std::unique_ptr<Physics> physics;
  std::unique_ptr<ArmBody> body;
};

PerJoint pose(Stream& draw) {
  const double q2 = -0.5 + 1.5 * draw.uniform();
  return {-1.2 + 2.4 * draw.uniform(), q2, q2 - 1.0 + 1.8 * draw.uniform()};
}

TEST(ArmModel, IsTheMachineOfTheCore) {
  for (const double scale : {0.8, 1.0, 1.2}) {
    ArmTruth truth;
    truth.mass_scale = scale;
    truth.machine.phantom.l2 *= scale;
    Bodies bodies(truth);
    const Arm arm(bodies.machine);
    Stream draw(7, "poses");
    for (int k = 0; k < 300; ++k) {
      const PerJoint q = pose(draw);
      bodies.put(q);
      const mjData* d = bodies.physics->data();
      EXPECT_LT((bodies.body->tip(d).e() - arm.tip(q).e()).norm(), 1e-12);
      const Vec3 weight =
          bodies.ties().transpose() * Eigen::Map<const Eigen::Matrix<double, 5, 1>>(d->qfrc_bias);
      const PerJoint own = arm.gravity(q, kPlate.mass, Payload::exact);
      EXPECT_LT((weight - Vec3(own[0], own[1], own[2])).norm(), 1e-12);
      Eigen::Matrix<double, 5, 5> full;
      mj_fullM(bodies.physics->model(), d, full.data());
      const Mat3 mass = bodies.ties().transpose() * full * bodies.ties();
      EXPECT_LT((mass - arm.mass(q, kPlate.mass)).norm(), 1e-9 * mass.norm());
    }
  }
}

// Swings that meet no limit: the energy stays, and the parallelogram stays shut.
TEST(ArmModel, KeepsItsEnergyAndItsParallelogram) {
  ArmTruth truth;
  truth.friction = truth.viscous = {};
  Stream draw(3, "swings");
  for (int k = 0; k < 20; ++k) {
    Bodies bodies(truth);
    mjModel* m = bodies.physics->model();
    mjData* d = bodies.physics->data();
    m->opt.enableflags |= mjENBL_ENERGY;
    bodies.put({0.0, 0.1, 0.1});
    const Eigen::Matrix<double, 5, 1> v = bodies.ties() * (draw.normal3().normalized() * 2.0);
    std::copy_n(v.data(), 5, d->qvel);
    mj_forward(m, d);
    const double kinetic = d->energy[1], before = d->energy[0] + d->energy[1];
    double gap = 0.0;
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(bodies.physics->step());
      gap = std::max(gap, bodies.body->gap(d));
    }
    mj_forward(m, d);
    EXPECT_LT(std::abs(d->energy[0] + d->energy[1] - before), 1e-5 * kinetic) << k;
    EXPECT_LT(gap, 1e-6) << k;
  }
}

}  // namespace
}  // namespace enc::sim
