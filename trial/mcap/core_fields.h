// Fields of the haptic core, the gripper and the display for a tick; record_fields.h has the others.
#pragma once

#include <string>
#include <vector>

#include "core/control/scene/scene.h"
#include "trial/mcap/record_fields.h"

namespace enc::trial {

[[nodiscard]] inline std::string_view mode_word(Mode mode) {
  return static_cast<int>(mode) < kModes ? mode_name(mode) : "unknown";
}
// Empty for a device that the scene lacks.
[[nodiscard]] inline std::optional<std::string_view> health_if(bool has, Health health) {
  if (!has) return {};
  return word_if_any(health);
}

template <class F>
void core_fields(F& f, const Scene& scene, const std::vector<std::string>& objects,
                 const std::vector<std::string>& tools, const RecordedTick& frame) {
  const Inputs& in = frame.in;
  const Outputs& out = frame.out;
  f.integer("tick", "number of the cycle", frame.tick.index);
  f.text("mode", "away, follow, contact, restore, hold, probe or travel", mode_word(out.mode));
  f.text("why", "reasons and notices; empty: none", why_text(out.why));
  f.integer("why_bits", "the same, as bits", out.why);
  f.text_if("object", "the nearest, or the one in contact", name_at(objects, out.object));
  f.text_if("tool", "that the tracker sees", name_at(tools, out.view.tool));
  f.integer("contacts", "since the start", out.contacts);
  f.number("gap_m", "of the tool's tip to the surface; negative inside", out.gap);
  f.number("deflection_m", "wanted; of a probe: measured, negative before it touches", out.deflection);
  vector_field(f, "force_N", "on the tip, low-passed, in N: z along the outward normal", out.force);
  vector_field(f, "felt_N", "the same before the low-pass, in W", out.felt);
  vector_field(f, "first_touch_m", "centre of the tip at the first touch of the contact, in W",
               out.first_touch);
  vector_field(f, "tool_tip_m", "centre of the tool's tip as tracked, in W", out.view.tip);
  f.text_if("tool_health", "what the tracker says of itself", health_if(scene.has_tracker, in.tool.health));
  f.text_if("tip_health", "what the machine says of itself", health_if(scene.has_manipulator, in.tip.health));
  f.text_if("wrench_health", "what the sensor says of itself", health_if(scene.has_force, in.wrench.health));
  f.integer("missed_cycles", "that passed before this one without a tick", in.missed);
  f.flag("withheld", "what the machine is told was not sent", in.withheld);
  f.flag("resumed", "the machine's link came back", in.resumed);
}

template <class F>
void surface_fields(F& f, const std::vector<std::string>& objects, const Stamped<DentSample>& dent) {
  f.text_if("object", "that is dented", name_at(objects, dent.value.object));
  f.number("depth_m", "of the tip's lowest point below the undeformed surface", dent.value.depth);
  vector_field(f, "tip_m", "centre of the tip that dents it, in O", dent.value.tip.centre);
  f.text("health", "what the display says of itself", word_if_any(dent.health));
  stamp_field(f, dent);
}

template <class F>
void gripper_fields(F& f, const Stamped<GripSample>& grip, const Grip& told) {
  f.flag("told_closed", "what it is told", told.closed);
  f.number("told_force_N", "", told.force);
  f.text("phase", "open, closing, closed or opening", word_if_any(grip.value.phase));
  f.number("opening_m", "between the jaws", grip.value.opening);
  f.number("force_N", "on what is clamped", grip.value.force);
  f.flag("holding", "something is between the jaws", grip.value.holding);
  f.text("health", "what the gripper says of itself", word_if_any(grip.health));
  stamp_field(f, grip);
}

}  // namespace enc::trial
