// The work of a physics step on a machine, in J: the ground truth of the energy balance (trial/ledger). It
// only observes; the world does not depend on it.
//
// The touching body itself serves as the scale for the contact force. The hand pushes a tool of mass m with g
// over the step of h; the machine has then pushed it back by
//
//   F = m (v_1 - v_0) / h - g
//
// in the mean of the step. This is exact for every integrator that sums accelerations, and independent of the
// machine's own equations of motion. The work of F is that on the touched point of the machine.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sim/bodies/arm_model.h"
#include "sim/bodies/mujoco.h"
#include "sim/spec/arm_spec.h"
#include "sim/truth/truth.h"

namespace enc::sim {

// The pushing tool: the first of its three slides, its mass, kg, and the radius of its tip, m.
struct Scale {
  int dof = -1;
  double mass = 0.0, radius = 0.0;
};

class StepWork {
 public:
  // Call this before a step, when all its forces are set; `torque`: of an arm's motors, N m or N.
  void begin(const Physics& physics, const Scale& tool, const ArmBody* arm, const PerJoint& torque);
  // After the step: mean force on the machine, N in W.
  [[nodiscard]] Vec3 pushed(const Physics& physics, double h) const;
  [[nodiscard]] const PerJoint& rates() const { return rates_; }  // arm only, at the start of the step
  // Adds the step's work on an arm whose motors pushed with `torque`, and whose smooth friction pushed with
  // `smooth`, N m or N.
  void count(const Physics& physics, const ArmBody& arm, const ArmTruth& truth, const PerJoint& torque,
             const PerJoint& smooth, double h, Work& sum);

 private:
  static constexpr std::size_t kMostDofs = 12;
  using PerDof = std::array<double, kMostDofs>;  // the world's coordinates
  // Torques at one end of a step: dry friction, and the joint stops.
  struct EndTorques {
    PerJoint friction{};
    PerDof stops{};
  };
  void look(const Physics& physics);
  [[nodiscard]] static EndTorques held_back(const Physics& physics, const ArmBody& arm);
  [[nodiscard]] Vec3 touched_first(const Physics& physics, const ArmBody& arm) const;

  Scale tool_;
  Vec3 velocity_ = Vec3::Zero(), applied_ = Vec3::Zero();  // velocity of the tool; force of the hand on it
  PerJoint joints_{}, rates_{};
  PerDof qpos_{};
  EndTorques held_;  // values at the start of the step
  PerJoint torque_{kUnset, kUnset, kUnset};
  std::vector<double> warm_;
  Vec3 tip_ = Vec3::Zero();  // body that carries the prop
  Quat turned_{Quat::Identity()};
};

}  // namespace enc::sim
