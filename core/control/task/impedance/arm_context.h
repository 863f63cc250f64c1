// Data that pass through the stages of a tick of an arm.
#pragma once

#include <span>

#include "core/control/stages/step_context.h"

namespace enc::stages {

struct ArmContext : StepContext {
  using StepContext::StepContext;
  // Set by guide(): target of an arm that follows no finger; unset: the arm waits.
  Point<'W'> guide_target;
  // track of a dynamic object: the objects that move, and their states
  std::span<const Mover> movers;
  std::span<MoverState> moved;
  Mat3 jacobian = Mat3::Zero();             // track
  Vec<'W'> tip_velocity;                    // track
  Vec3 target_acceleration = Vec3::Zero();  // aim: acceleration of the target on its path, m/s^2
  Vec3 target_change = Vec3::Zero();        // aim: that acceleration on and off its path, m/s^2
  Vec<'W'> law_force;                       // impede: force that the law requests; unset: none
  double along_mass = 0.0;   // impede: kg, tip mass along the normal, with a passivity controller
  Vec<'R'> commanded_force;  // guard: includes gravity compensation
};

}  // namespace enc::stages
