// An arm's machine as bodies of MuJoCo, two ways: built here body by body, and as the twin has it.
#pragma once

#include <random>

#include <Eigen/Core>

#include "core/machine/arm.h"
#include "sim/bodies/arm_model.h"
#include "sim/bodies/mujoco.h"

namespace enc::test {

// The physics of an arm and d (MuJoCo's joints) / d (arm's joints).
struct Built {
  sim::Physics physics;
  Eigen::MatrixXd G;
};
// Bodies hang on a tree of five hinges. Its joints, in MuJoCo's order: q1, q2, q3 - q2 (forearm on upper
// arm), q3 (crank), q2 - q3 (link on crank).
[[nodiscard]] Built phantom(const ArmMachine& machine, double payload);
[[nodiscard]] Built chain(const ArmMachine& machine, double payload);

// The twin's own model of it, of either kind.
struct ArmTwin {
  sim::Physics physics;
  sim::ArmBody body;
};
[[nodiscard]] ArmTwin twin(const ArmMachine& machine, double payload, const sim::ArmTruth& truth = {});

[[nodiscard]] inline Vec3 vector(const PerJoint& of) { return {of[0], of[1], of[2]}; }
[[nodiscard]] inline PerJoint per_joint(const Vec3& of) { return {of.x(), of.y(), of.z()}; }

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

}  // namespace enc::test
