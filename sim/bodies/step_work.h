// What a step of the physics does to a machine, in J: the truth of the energy ledger (trial/ledger). It looks
// on: nothing in the world depends on it.
//
// Of the force that touches the tip, what touches it is the scale. A tool of mass m, which the hand pushes
// with g over the step of h, has been pushed back by
//
//   F = m (v_1 - v_0) / h - g
//
// in the mean of the step: exact whatever the integrator, which adds up accelerations. It owes nothing to the
// machine's own equations of motion. Its work is that on the point of the machine that it touches.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sim/bodies/arm_model.h"
#include "sim/bodies/mujoco.h"
#include "sim/spec/arm_spec.h"
#include "sim/truth/truth.h"

namespace enc::sim {

// The tool that pushes: the first of its three slides, its mass, kg, and the radius of its tip, m.
struct Scale {
  int dof = -1;
  double mass = 0.0, radius = 0.0;
};

class StepWork {
 public:
  // Before a step, when all its forces are there; `torque`: of an arm's motors, N m or N.
  void begin(const Physics& physics, const Scale& tool, const ArmBody* arm, const PerJoint& torque);
  // After it: mean force on the machine, N in W.
  [[nodiscard]] Vec3 pushed(const Physics& physics, double h) const;
  [[nodiscard]] const PerJoint& rates() const { return rates_; }  // of an arm, when it began
  // What it did to an arm, whose motors pushed with `torque` and whose friction of the smooth form with
  // `smooth`, N m or N.
  void count(const Physics& physics, const ArmBody& arm, const ArmTruth& truth, const PerJoint& torque,
             const PerJoint& smooth, double h, Work& sum);

 private:
  static constexpr std::size_t kMostDofs = 12;
  using PerDof = std::array<double, kMostDofs>;  // of the world's coordinates
  // Torques at an end of a step: of dry friction, and of what ends a joint's way.
  struct Held {
    PerJoint friction{};
    PerDof stops{};
  };
  void look(const Physics& physics);
  [[nodiscard]] static Held held_back(const Physics& physics, const ArmBody& arm);
  [[nodiscard]] Vec3 touched_first(const Physics& physics, const ArmBody& arm) const;

  Scale tool_;
  Vec3 velocity_ = Vec3::Zero(), applied_ = Vec3::Zero();  // of the tool; of the hand on it
  PerJoint joints_{}, rates_{};
  PerDof qpos_{};
  Held held_;  // as it began
  PerJoint torque_{kUnset, kUnset, kUnset};
  std::vector<double> warm_;
  Vec3 tip_ = Vec3::Zero();  // of the body that the prop is on
  Quat turned_{Quat::Identity()};
};

}  // namespace enc::sim
