// An arm and its prop as MuJoCo bodies: exact lengths, masses and inertias, rotors as armature, friction and
// limits. A PHANToM is a turret with two hinges; the load of its parallelogram is assigned to these
// (docs/reference/phantom_twin.md). core/machine/arm_shape.h defines the look of links and base.
#pragma once

#include <array>
#include <optional>

#include "core/machine/arm.h"
#include "core/spec/scene_spec.h"
#include "sim/bodies/mujoco.h"
#include "sim/spec/arm_spec.h"

namespace enc::sim {

struct ArmParts {
  const ArmMachine& machine;  // ground truth, with its true masses
  const ArmTruth& truth;
  const PropSpec* prop = nullptr;  // null: the tip is bare and cannot be touched
  Pose<'W', 'R'> X_WR;             // true pose of its base
};

// Adds the bodies, joints `arm_1` to `arm_3` in the machine's order (a PHANToM has `arm_elbow`, q3 - q2, in
// place of the third), and the body `prop` with its origin at H. Throws Error if a body is impossible.
void build_arm(mjSpec* spec, const ArmParts& parts);

// State of an arm in a compiled world.
class ArmBody {
 public:
  ArmBody(const Physics& physics, std::size_t joints);

  [[nodiscard]] PerJoint joints(const mjData* data) const noexcept;
  [[nodiscard]] PerJoint rates(const mjData* data) const noexcept;
  // Sets these joints and rates; derived values follow at the next evaluation of the physics.
  void put(mjData* data, const PerJoint& joints, const PerJoint& rates) const noexcept;
  // Motor torque that would keep the rates, in the last evaluation, N m or N: weight, coupling of the moving
  // joints, and viscous friction. Excludes dry friction.
  [[nodiscard]] PerJoint load(const mjData* data) const noexcept;
  // Mass matrix of those joints, from the last evaluation; missing joints have 0.
  [[nodiscard]] Mat3 mass(const mjModel* model, const mjData* data) const;
  // Position of H, from the last evaluation of the physics.
  [[nodiscard]] Point<'W'> tip(const mjData* data) const noexcept;
  [[nodiscard]] Quat turned(const mjData* data) const noexcept;  // rotation of the link that carries the prop
  [[nodiscard]] Vec<'W'> tip_velocity(const mjModel* model, const mjData* data) const noexcept;
  void drive(mjData* data, const PerJoint& torque) const noexcept;
  // Turns the prop's gimbal: its front, which is at H, faces along z of N, whatever the arm does. The gimbal
  // has neither inertia nor friction. `surface`: velocity of a driven front, W.
  void face(mjModel* model, const mjData* data, const Quat& q_WN, const Vec3& surface) const noexcept;
  [[nodiscard]] std::size_t joint_of(int dof) const noexcept;  // joint of a MuJoCo dof
  [[nodiscard]] int front() const { return front_; }           // geom; -1: no front

 private:
  std::size_t joints_;
  std::array<int, kMostJoints> qpos_{}, dof_{};
  bool folds_ = false;  // the third coordinate is q3 - q2
  int tip_ = -1, front_ = -1;
  Vec3 middle_ = Vec3::Zero();  // middle of the front's box, in N
};

}  // namespace enc::sim
