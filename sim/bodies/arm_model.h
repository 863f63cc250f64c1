// An arm and its prop as bodies of MuJoCo: exact lengths, masses and inertias, rotors as armature, friction
// and limits. A PHANToM is a turret with two hinges: what its parallelogram carries is counted to those
// (docs/reference/phantom_twin.md). How links and base look, core/machine/arm_shape.h says.
#pragma once

#include <array>
#include <optional>

#include "core/machine/arm.h"
#include "core/spec/scene_spec.h"
#include "sim/bodies/mujoco.h"
#include "sim/spec/arm_spec.h"

namespace enc::sim {

struct ArmParts {
  const ArmMachine& machine;  // as it is, with its true masses
  const ArmTruth& truth;
  const PropSpec* prop = nullptr;  // none: the tip is bare and nothing can touch it
  Pose<'W', 'R'> X_WR;             // where its base really stands
};

// Bodies, joints `arm_1` to `arm_3` in the order of the machine's (of a PHANToM `arm_elbow`, q3 - q2, is in
// the place of the third), body `prop` with its origin at H. Throws Error where a body cannot be.
void build_arm(mjSpec* spec, const ArmParts& parts);

// Where an arm is in a compiled world.
class ArmBody {
 public:
  ArmBody(const Physics& physics, std::size_t joints);

  [[nodiscard]] PerJoint joints(const mjData* data) const noexcept;
  [[nodiscard]] PerJoint rates(const mjData* data) const noexcept;
  // To these joints and rates; what follows from them is for the next evaluation of the physics.
  void put(mjData* data, const PerJoint& joints, const PerJoint& rates) const noexcept;
  // What the motors would have to do to keep the rates as they are, in the last evaluation, N m or N: weight,
  // what turning joints do to each other, and viscous friction. Not the dry one.
  [[nodiscard]] PerJoint load(const mjData* data) const noexcept;
  // Mass matrix of those joints, of the last evaluation; joints that are not there have 0.
  [[nodiscard]] Mat3 mass(const mjModel* model, const mjData* data) const;
  // Of H; as the last evaluation of the physics left it.
  [[nodiscard]] Point<'W'> tip(const mjData* data) const noexcept;
  [[nodiscard]] Quat turned(const mjData* data) const noexcept;  // the link that carries the prop
  [[nodiscard]] Vec<'W'> tip_velocity(const mjModel* model, const mjData* data) const noexcept;
  void drive(mjData* data, const PerJoint& torque) const noexcept;
  // The prop's gimbal: its front, which is at H, faces along z of N whatever the arm does. It has neither
  // inertia nor friction. `surface`: velocity of a driven front, W.
  void face(mjModel* model, const mjData* data, const Quat& q_WN, const Vec3& surface) const noexcept;
  [[nodiscard]] std::size_t joint_of(int dof) const noexcept;  // of MuJoCo's
  [[nodiscard]] int front() const { return front_; }           // geom; -1: there is none

 private:
  std::size_t joints_;
  std::array<int, kMostJoints> qpos_{}, dof_{};
  bool folds_ = false;  // the third coordinate is q3 - q2
  int tip_ = -1, front_ = -1;
  Vec3 middle_ = Vec3::Zero();  // of the front's box, in N
};

}  // namespace enc::sim
