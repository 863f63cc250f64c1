// The state that every task needs, and that of a contact.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "core/base/fields.h"
#include "core/base/sample.h"
#include "core/base/time.h"
#include "core/control/track/predict.h"
#include "core/control/world/object.h"
#include "core/devices/mode.h"

namespace enc {

// The anchor of a contact: the touched object, the tool and the position [VHMR 3.4].
struct Contact {
  std::int32_t object = -1;
  std::int32_t tool = -1;  // tool that began the contact; -1: unknown
  Pose<'W', 'N'> X_WN;     // anchor frame, set by the first touch
  // True once the sensor measured a force with the tip under the tool; the anchor no longer moves then.
  bool anchored = false;
  // True before the first force, while the tip is still on its way to the anchor, lower than its tool.
  bool below = false;
  // The contact's own tool is out of view. This may stay true after the contact, because the tool may still
  // press; the core then learns no force zero until the tool is seen clear of the object.
  bool unseen = false;
  // N: the force that has stayed constant while the contact's own tool is unseen.
  float steady_force = 0.0F;
  Time loaded{};         // last tick with force, of an arm with its prop pushed in; the start of time: never
  Time began{}, left{};  // start of the contact, and of the tip's return
  // Time for which the force has had no cause, s (force_is_drift in admittance/mode.cpp).
  double clear = 0.0;
};

template <class F>
void fields(F& f, Contact& c) {
  f("contact_object", c.object);
  f("contact_tool", c.tool);
  fields(f, "contact_X_WN", c.X_WN);
  f("anchored", c.anchored);
  // Hashed only when true, which is rare, so that earlier hashes hold.
  if (c.below) f("contact_below", c.below);
  f("loaded", c.loaded);
  f("contact_began", c.began);
  f("contact_left", c.left);
  f("contact_clear", c.clear);
  if (c.steady_force != 0.0F) f("contact_steady_force", c.steady_force);
  if (c.unseen) f("contact_unseen", c.unseen);
}

struct Hints {
  std::array<ObjectHint, 2> tool;  // nearest to the tool, and the runner-up
  ObjectHint tip;                  // nearest to the tip
  ObjectHint command;              // nearest to the tip's set-point
};

struct CommonState {
  bool started = false;
  Mode mode = Mode::away;  // the mode underneath a hold
  bool held = false;       // the last tick was a hold
  std::int32_t contacts = 0;
  std::int32_t object = -1;
  bool entered = false;  // the tip has been inside that object
  Measurement<TrackedTool> tool;
  Time tool_came{};           // arrival of that pose
  bool tool_missing = false;  // the two poses after it are overdue
  TipMotion tip_motion;       // motion of the tracked tool's tip
  Vec<'W'> force = Vec<'W'>::zero();
  // Last tick's position of the tracked tool's tip, and the surface point under it.
  Point<'W'> last_query, last_point;
  Hints hints;
};
static_assert(std::is_trivially_copyable_v<CommonState>);

template <class F>
void fields(F& f, std::string_view name, ObjectHint& h) {
  f(name, h.object);
  f(name, h.feature);
}
template <class F>
void fields(F& f, TipMotion& m) {
  f("motion_tool", m.tool);
  f("motion_t", m.t);
  fields(f, "motion_position_W", m.position);
  fields(f, "motion_velocity_W", m.velocity);
  fields(f, "motion_acceleration_W", m.acceleration);
  for (AxisDoubt* const d : {&m.along, &m.across})
    for (double* const x : {&d->xx, &d->xv, &d->xa, &d->vv, &d->va, &d->aa}) f("motion_covariance", *x);
}
template <class F>
void fields(F& f, CommonState& s) {
  f("started", s.started);
  f("state_mode", s.mode);
  f("held", s.held);
  f("state_contacts", s.contacts);
  f("state_object", s.object);
  f("entered", s.entered);
  fields(f, s.tool);
  if (s.tool_missing) f("tool_came", s.tool_came);  // rare, so that earlier hashes hold
  fields(f, s.tip_motion);
  fields(f, "force_W", s.force);
  fields(f, "last_query_W", s.last_query);
  fields(f, "last_point_W", s.last_point);
  fields(f, "nearest_hint", s.hints.tool[0]);
  fields(f, "runner_up_hint", s.hints.tool[1]);
  fields(f, "tip_hint", s.hints.tip);
  fields(f, "command_hint", s.hints.command);
}

}  // namespace enc
