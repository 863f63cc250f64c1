// Ground truth of the simulator. Only benchmarks and reports may use it; the core never can.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/frames.h"
#include "core/base/time.h"
#include "core/machine/arm.h"
#include "core/record/state_hash.h"

namespace enc::sim {

enum class Phase : std::uint8_t {
  wait,
  approach,
  press,
  hold,
  release,
  retreat,
  change
};  // change: the hand changes tools

// Work on a machine since the last tick, J: sums over the steps of the physics (bodies/step_work.h). Unset
// unless requested (World::ask_for_work).
struct Work {
  // Work of the body that touches its tip, measured on that body.
  double contact = 0.0;
  // Hexapod only: the same work as measured by an error-free force sensor.
  double sensed = 0.0;
  double motors = 0.0;    // work of an arm's motors
  double friction = 0.0;  // dissipated by the joints' dry friction and stops
  double viscous = 0.0;   // dissipated by the joints' viscous friction
  PerJoint rates{};       // arm's joints at this tick, rad/s or m/s
};

struct Truth {
  Time t{};
  Point<'W'> tool_tip;  // centre of the tool's tip
  Vec<'W'> tool_velocity = Vec<'W'>::zero();
  Point<'W'> tip;  // centre of the haptic-tip; arm: H, the middle of its prop's front
  Vec<'W'> tip_velocity = Vec<'W'>::zero();
  Vec<'W'> tip_acceleration = Vec<'W'>::zero();  // hexapod only
  Vec<'W'> contact_force = Vec<'W'>::zero();     // tool or real ball on the haptic-tip, N
  Vec<'W'> hand_force = Vec<'W'>::zero();        // hand on the tool, N
  std::array<double, 6> leg_force{               // N, structural form: force of each leg on the platform.
                                  kUnset, kUnset, kUnset, kUnset, kUnset, kUnset};
  // Arm only: joints (rad or m), motor torques (N m), and temperature rises of the windings relative to that
  // of the continuous torque (arm_plant.h).
  PerJoint joints{kUnset, kUnset, kUnset}, motor_torque{kUnset, kUnset, kUnset},
      warmth{kUnset, kUnset, kUnset};
  bool touching = false;
  double penetration = kUnset;  // probe in the real ball, along their normal, m; negative: gap
  double tool_radius = kUnset, tip_radius = kUnset;
  // The person's activity: the press, and its phase.
  std::int32_t press = -1;
  std::int32_t aim = -1;  // object to press, index in the scene
  Phase phase = Phase::wait;
  double approach_speed = kUnset;  // this press, m/s, as planned
  bool aborted = false;            // this reach turns back before the touch
  std::int32_t tool = -1;          // tool in the hand, index in the scene; -1: no tool
  Work work;
};

// The fields of the truth, named once, as core/record/state_hash.h does for the core's data: for a hash over
// the true events.
template <class F>
void fields(F& f, Truth& t) {
  f("t", t.t);
  for (detail::Triple* v :
       std::initializer_list<detail::Triple*>{&t.tool_tip, &t.tool_velocity, &t.tip, &t.tip_velocity,
                                              &t.tip_acceleration, &t.contact_force, &t.hand_force})
    enc::fields(f, "vector_W", *v);
  enc::fields(f, "leg_force", t.leg_force);
  enc::fields(f, "joints", t.joints);
  enc::fields(f, "motor_torque", t.motor_torque);
  enc::fields(f, "warmth", t.warmth);
  f("touching", t.touching);
  for (double* x : {&t.penetration, &t.tool_radius, &t.tip_radius, &t.approach_speed}) f("number", *x);
  for (std::int32_t* x : {&t.press, &t.aim, &t.tool}) f("index", *x);
  f("phase", t.phase);
  f("aborted", t.aborted);
}

}  // namespace enc::sim
