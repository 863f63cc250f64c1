// The fields of the truth, named once, as core/record/state_hash.h does for the core's data: for a hash over
// the true events.
#pragma once

#include "core/record/state_hash.h"
#include "sim/truth/truth.h"

namespace enc::sim {

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
