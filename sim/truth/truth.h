// What really is, in the simulator. Only benchmarks and reports may ask; the core never can.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/frames.h"
#include "core/base/time.h"
#include "core/machine/arm.h"

namespace enc::sim {

enum class Phase : std::uint8_t {
  wait,
  approach,
  press,
  hold,
  release,
  retreat,
  change
};  // change: of tools

// What was done to a machine since the last tick, J: sums over the steps of the physics (bodies/step_work.h).
// Nothing where nobody asked for it (World::ask_for_work).
struct Work {
  double contact = 0.0;   // of what touches its tip, as that feels it
  double sensed = 0.0;    // the same of a hexapod, as its sensor would feel it without any error
  double motors = 0.0;    // of an arm's motors
  double friction = 0.0;  // taken by the joints' dry friction and stops
  double viscous = 0.0;   // and by their viscous one
  PerJoint rates{};       // of an arm's joints at this tick, rad/s or m/s
};

struct Truth {
  Time t{};
  Point<'W'> tool_tip;  // centre of the tool's tip
  Vec<'W'> tool_velocity = Vec<'W'>::zero();
  Point<'W'> tip;  // centre of the haptic-tip; of an arm: H, the middle of its prop's front
  Vec<'W'> tip_velocity = Vec<'W'>::zero();
  Vec<'W'> tip_acceleration = Vec<'W'>::zero();  // of a hexapod
  Vec<'W'> contact_force = Vec<'W'>::zero();     // of the tool or the real ball on the haptic-tip, N
  Vec<'W'> hand_force = Vec<'W'>::zero();        // of the hand on the tool, N
  std::array<double, 6> leg_force{
      kUnset, kUnset, kUnset, kUnset, kUnset, kUnset};  // N, structural form:
                                                        // with which each leg pushes the platform
  // Of an arm: its joints, what its motors give, and how warm their windings are (arm_plant.h).
  PerJoint joints{kUnset, kUnset, kUnset}, motor_torque{kUnset, kUnset, kUnset},
      warmth{kUnset, kUnset, kUnset};  // rad or m; N m; 1: as by the continuous torque
  bool touching = false;
  double penetration = kUnset;  // of the probe into the real ball, along their normal, m; negative: the gap
  double tool_radius = kUnset, tip_radius = kUnset;
  // What the person is at: which press, and which part of it.
  std::int32_t press = -1;
  std::int32_t aim = -1;  // the object that is pressed, index in the scene
  Phase phase = Phase::wait;
  double approach_speed = kUnset;  // of this press, m/s, as planned
  bool aborted = false;            // this reach turns back before the touch
  std::int32_t tool = -1;          // in the hand, index in the scene; -1: none
  Work work;
};

}  // namespace enc::sim
