// Names every number that passes through a tick, once. The record, its layout hash and the state hash all use
// these functions, field by field and never over padding (sources/choices 8). A visitor is called with (name,
// leaf) for each number.
#pragma once

#include <string_view>

#include "core/base/fields.h"
#include "core/control/step.h"

namespace enc {

template <class F>
void fields(F& f, Tick& k) {
  f("index", k.index);
  f("t", k.t);
  f("dt", k.dt);
}
template <class F>
void fields(F& f, TrackedTool& s) {
  f("tool", s.tool);
  fields(f, "X_CT", s.X_CT);
  f("noise_along", s.along);
  f("noise_across", s.across);
}
template <class F>
void fields(F& f, Wrench& s) {
  fields(f, "force_F", s.force);
  fields(f, "torque_F", s.torque);
}
template <class F>
void fields(F& f, TipSample& s) {
  fields(f, "X_RH", s.X_RH);
  fields(f, "velocity_R", s.velocity);
  fields(f, "acceleration_R", s.acceleration);
}
template <class F>
void fields(F& f, ArmSample& s) {
  fields(f, "joints", s.joints);
  fields(f, "joint_velocities", s.joint_velocities);
  fields(f, "arm_tip_R", s.tip);
  fields(f, "arm_velocity_R", s.velocity);
}
template <class F>
void fields(F& f, DentSample& s) {
  f("dent_object", s.object);
  fields(f, "dent_tip_O", s.tip.centre);
  f("dent_tip_radius", s.tip.radius);
  f("dent_tip_shape", s.tip.shape);
  fields(f, "dent_tip_axis_O", s.tip.axis);
  f("dent_tip_half_angle", s.tip.half_angle);
  f("dent_tip_length", s.tip.length);
  f("dent_depth", s.depth);
}
template <class F>
void fields(F& f, GripSample& s) {
  f("grip_phase", s.phase);
  f("grip_opening", s.opening);
  f("grip_force", s.force);
  f("grip_holding", s.holding);
}
template <class F>
void fields(F& f, Grip& g) {
  f("grip_closed", g.closed);
  f("grip_wanted_force", g.force);
}
template <class F, class V>
void fields(F& f, Measurement<V>& s) {
  fields(f, s.value);
  f("stamp", s.t);
  f("health", s.health);
}
template <class F>
void fields(F& f, Inputs& in) {
  fields(f, in.tool);
  fields(f, in.wrench);
  fields(f, in.tip);
  fields(f, in.arm);
  fields(f, in.dent);
  fields(f, in.grip);
  f("missed", in.missed);
  f("withheld", in.withheld);
  f("resumed", in.resumed);
}
template <class F>
void fields(F& f, View& v) {
  f("view_t", v.t);
  f("view_tool", v.tool);
  f("view_object", v.object);
  fields(f, "view_X_WT", v.X_WT);
  fields(f, "view_tip_W", v.tip);
  f("view_mode", v.mode);
}
template <class F>
void fields(F& f, Outputs& out) {
  fields(f, "tip_X_RH", out.manipulator.tip);
  f("mode", out.mode);
  f("why", out.why);
  f("object", out.object);
  f("contacts", out.contacts);
  f("gap", out.gap);
  fields(f, "force_N", out.force);
  fields(f, "felt_W", out.force_unfiltered);
  f("deflection", out.deflection);
  fields(f, "first_touch_W", out.first_touch);
  fields(f, out.view);
  fields(f, out.manipulator.grip);
  fields(f, "arm_force_R", out.arm.force);
  fields(f, "wanted_W", out.arm.target);
  f("gain", out.arm.gain);
  f("prop_speed", out.arm.prop_speed);
  fields(f, "prop_facing_R", out.arm.prop_facing);
}

}  // namespace enc
