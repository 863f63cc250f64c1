// The part shared by all tasks of a machine that takes positions: each tick commands a position, and the
// machine must follow.
#pragma once

#include "core/base/fields.h"
#include "core/control/safety/following.h"
#include "core/control/stages/step_context.h"

namespace enc {

// Base of such a task. It uses the stages of this file unless it has its own.
struct DisplacementTask {};

// State of these stages.
struct CommandState {
  Point<'R'> command;  // last set-point
  Vec<'R'> command_velocity = Vec<'R'>::zero();
  FollowingState following;
  Vec<'F'> force_zero = Vec<'F'>::zero();
  double tared = 0.0;  // s of signal in force_zero
  // Means over Tare::window: the present window so far, and the one before.
  Vec<'F'> tare_mean, tare_last;
  double tare_window = 0.0;  // s of signal in tare_mean
};

template <class F>
void fields(F& f, CommandState& d) {
  fields(f, "force_zero_F", d.force_zero);
  f("tared", d.tared);
  fields(f, "tare_mean_F", d.tare_mean);
  fields(f, "tare_last_F", d.tare_last);
  f("tare_window", d.tare_window);
  fields(f, "command_R", d.command);
  fields(f, "command_velocity_R", d.command_velocity);
  fields(f, "expected_R", d.following.expected);
  fields(f, "expected_velocity_R", d.following.velocity);
  f("fastest_command", d.following.deviation.fastest);
  f("off_course", d.following.deviation.off);
  f("lost", d.following.lost);
}

namespace stages {
// Data of one tick of such a task.
struct ManipulatorContext : StepContext {
  using StepContext::StepContext;
  Vec<'W'> force;     // sense: force on the tip, N
  Point<'W'> target;  // act: commanded tip centre, before guard
};
// Computes the poses of tip and tool.
void track(ManipulatorContext& context, const DisplacementTask& task, CommonState& state,
           CommandState& now) noexcept;
// Checks that the gripper holds its tool, if the scene has a clamped tool.
void grip(ManipulatorContext& context) noexcept;
// Computes the force on the tip. `clear`: nothing can touch the tip, so the sensor's reading is its zero.
void sense(ManipulatorContext& context, CommonState& state, CommandState& now, bool clear) noexcept;
// Holds a machine that did not follow.
void hold_lost(ManipulatorContext& context, CommonState& state, CommandState& now) noexcept;
}  // namespace stages

}  // namespace enc
