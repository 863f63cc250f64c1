// The fields of what walks through a tick, named once: the record, its layout hash and the state hash all go
// through here, field by field and never over padding (sources/choices 8).
// A visitor is called with (name, leaf) for each number.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "core/step.h"

namespace enc {

template <class F, class T, std::size_t N>
void fields(F& f, std::string_view name, std::array<T, N>& a) {
  for (T& x : a) f(name, x);
}
template <class F>
void fields(F& f, std::string_view name, detail::Triple& v) {
  fields(f, name, v.xyz);
}
template <class F, char A, char B>
void fields(F& f, std::string_view name, Pose<A, B>& X) {
  fields(f, name, X.xyzw);
  fields(f, name, X.xyz);
}
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
void fields(F& f, Stamped<V>& s) {
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
  fields(f, "tip_X_RH", out.tip);
  f("mode", out.mode);
  f("why", out.why);
  f("object", out.object);
  f("contacts", out.contacts);
  f("gap", out.gap);
  fields(f, "force_N", out.force);
  fields(f, "felt_W", out.felt);
  f("deflection", out.deflection);
  fields(f, "first_touch_W", out.first_touch);
  fields(f, out.view);
  fields(f, out.grip);
  fields(f, "arm_force_R", out.arm_force);
  fields(f, "wanted_W", out.wanted);
  f("gain", out.gain);
  f("prop_speed", out.prop_speed);
}
template <class F>
void fields(F& f, Swing& s) {
  f("swing_depth", s.depth);
  f("swing_slow_force", s.slow_force);
  f("swing_slow_depth", s.slow_depth);
  f("swing_exchanged", s.exchanged);
  f("swing_moved", s.moved);
  f("swing_stiffness", s.stiffness);
  f("carried", s.carried);
}
template <class F>
void fields(F& f, Contact& c) {
  f("contact_object", c.object);
  f("contact_tool", c.tool);
  fields(f, "contact_X_WN", c.X_WN);
  f("anchored", c.anchored);
  f("loaded", c.loaded);
  f("contact_began", c.began);
  f("contact_left", c.left);
  f("contact_clear", c.clear);
  f("response_deflection", c.response.deflection);
  f("response_alpha", c.response.alpha);
  fields(f, "response_stop", c.response.stop);
  fields(f, c.swing);
  fields(f, "displacement_N", c.displacement);
}
template <class F>
void fields(F& f, Probing& p) {
  f("probe_phase", p.phase);
  f("probe_elapsed", p.elapsed);
  f("probe_deflection", p.deflection);
}
template <class F>
void fields(F& f, TipMotion& m) {
  f("motion_tool", m.tool);
  f("motion_t", m.t);
  fields(f, "motion_position_W", m.position);
  fields(f, "motion_velocity_W", m.velocity);
  fields(f, "motion_acceleration_W", m.acceleration);
  for (double* const x : {&m.xx, &m.xv, &m.xa, &m.vv, &m.va, &m.aa}) f("motion_covariance", *x);
}
template <class F>
void fields(F& f, Travelling& t) {
  f("travel_phase", t.phase);
  f("travel_elapsed", t.elapsed);
  f("travel_leg", t.leg);
}
template <class F>
void fields(F& f, Reaching& r) {
  fields(f, "target_W", r.target);
  fields(f, "target_velocity_W", r.velocity);
  fields(f, "error_W", r.error);
  fields(f, "error_rate_W", r.error_rate);
  f("lambda", r.gain);
  f("sunk", r.sunk);
  f("caught_up", r.caught_up);
  f("blind", r.blind);
  f("target_fastest", r.straying.fastest);
  f("arm_off", r.straying.off);
  f("stuck", r.stuck);
  f("triggered", r.triggered);
}
template <class F>
void fields(F& f, Moved& m) {
  fields(f, "shift_W", m.shift);
  fields(f, "shift_velocity_W", m.velocity);
  f("moved_depth", m.depth);
  f("moved_deepest", m.deepest);
  f("moved_firmness", m.firmness);
}
template <class F>
void fields(F& f, std::string_view name, ObjectHint& h) {
  f(name, h.object);
  f(name, h.feature);
}
template <class F>
void fields(F& f, State& s) {
  f("started", s.started);
  f("state_mode", s.mode);
  f("held", s.held);
  f("state_contacts", s.contacts);
  f("state_object", s.object);
  f("entered", s.entered);
  f("outside_dent", s.outside_dent);
  fields(f, s.tool);
  fields(f, s.tip_motion);
  fields(f, s.dent);
  fields(f, "force_zero_F", s.force_zero);
  f("tared", s.tared);
  fields(f, "tare_mean_F", s.tare_mean);
  fields(f, "tare_last_F", s.tare_last);
  f("tare_window", s.tare_window);
  fields(f, "force_W", s.force);
  fields(f, s.contact);
  fields(f, s.probing);
  fields(f, s.travelling);
  fields(f, s.reaching);
  fields(f, "winding", s.heat.winding);
  fields(f, "housing", s.heat.housing);
  for (Moved& moved : s.moved) fields(f, moved);
  fields(f, "command_R", s.command);
  fields(f, "command_velocity_R", s.command_velocity);
  fields(f, "expected_R", s.following.expected);
  fields(f, "expected_velocity_R", s.following.velocity);
  f("fastest_command", s.following.straying.fastest);
  f("off_course", s.following.straying.off);
  f("lost", s.following.lost);
  fields(f, "last_query_W", s.last_query);
  fields(f, "last_point_W", s.last_point);
  fields(f, "nearest_hint", s.hints.tool[0]);
  fields(f, "runner_up_hint", s.hints.tool[1]);
  fields(f, "tip_hint", s.hints.tip);
  fields(f, "command_hint", s.hints.command);
}

// A leaf as eight bytes. Every NaN is the same NaN; -0 and 0 stay apart,
// because a bit-exact replay can tell them.
template <class T>
[[nodiscard]] std::uint64_t leaf_bits(const T& x) {
  if constexpr (std::is_same_v<T, double>)
    return std::isnan(x) ? 0x7ff8000000000000ULL : std::bit_cast<std::uint64_t>(x);
  else if constexpr (std::is_same_v<T, Time>)
    return static_cast<std::uint64_t>(x.time_since_epoch().count());
  else if constexpr (std::is_same_v<T, Duration>)
    return static_cast<std::uint64_t>(x.count());
  else
    return static_cast<std::uint64_t>(x);
}
template <class T>
void set_leaf(T& x, std::uint64_t bits) {
  if constexpr (std::is_same_v<T, double>)
    x = std::bit_cast<double>(bits);
  else if constexpr (std::is_same_v<T, Time>)
    x = Time(Duration(static_cast<std::int64_t>(bits)));
  else if constexpr (std::is_same_v<T, Duration>)
    x = Duration(static_cast<std::int64_t>(bits));
  else
    x = static_cast<T>(bits);
}

// 64-bit mixing hash over leaves, chained from tick to tick.
// Not cryptographic: it finds differences, not forgers.
struct StateHash {
  std::uint64_t value = 0x9e3779b97f4a7c15ULL;
  void add(std::uint64_t bits) {
    value = (value ^ bits) * 0xff51afd7ed558ccdULL;
    value ^= value >> 32;
  }
  template <class T>
  void operator()(std::string_view, T& x) {
    add(leaf_bits(x));
  }
};
inline void add_tick(StateHash& hash, State& state, Outputs& out) {
  fields(hash, state);
  fields(hash, out);
}

}  // namespace enc
