// What all tasks of a machine that takes positions share: it is sent somewhere on each tick, and it must
// follow.
#pragma once

#include "core/base/fields.h"
#include "core/control/safety/following.h"

namespace enc {

struct CommonState;

// Such a task: it has the stages of this file, where it has none of its own.
struct Displacing {};

// What is remembered.
struct Commanded {
  Point<'R'> command;  // last set-point
  Vec<'R'> command_velocity = Vec<'R'>::zero();
  Following following;
  Vec<'F'> force_zero = Vec<'F'>::zero();
  double tared = 0.0;             // s of signal in force_zero
  Vec<'F'> tare_mean, tare_last;  // Tare::window: of the present window so far, and of the one before
  double tare_window = 0.0;       // s of signal in tare_mean
};

template <class F>
void fields(F& f, Commanded& d) {
  fields(f, "force_zero_F", d.force_zero);
  f("tared", d.tared);
  fields(f, "tare_mean_F", d.tare_mean);
  fields(f, "tare_last_F", d.tare_last);
  f("tare_window", d.tare_window);
  fields(f, "command_R", d.command);
  fields(f, "command_velocity_R", d.command_velocity);
  fields(f, "expected_R", d.following.expected);
  fields(f, "expected_velocity_R", d.following.velocity);
  f("fastest_command", d.following.straying.fastest);
  f("off_course", d.following.straying.off);
  f("lost", d.following.lost);
}

namespace stages {
struct Walk;
// Where tip and tool are.
void track(Walk& walk, const Displacing& task, CommonState& state, Commanded& now) noexcept;
// Whether the gripper holds its tool, where it should hold one.
void grip(Walk& walk) noexcept;
// What force is on the tip. `clear`: nothing can be on it, so that what the sensor says is its zero.
void sense(Walk& walk, CommonState& state, Commanded& now, bool clear) noexcept;
// A machine that did not follow is held.
void hold_lost(Walk& walk, CommonState& state, Commanded& now) noexcept;
}  // namespace stages

}  // namespace enc
