// The presses of a session, from the ground truth: the encounter, the hand's force, and the effect of the
// tool change.
#pragma once

#include <vector>

#include "trial/measure/press_measure.h"

namespace enc::bench::session {

// One reach, and the press after it unless it turned back.
struct SessionPress {
  bool aborted = false;
  std::int32_t tool = -1;
  Vec3 normal = Vec3::Zero();            // normal of the place, in W: at the tool when it was nearest
  double nearest = trial::kInfinite;     // m, of the tool's tip to the surface; negative inside
  double miss = kUnset, delay = kUnset;  // m, s: PressFigures
  double touch_speed = kUnset;           // m/s, true speed of the tool when it meets the surface
  double impact = kUnset;  // N: largest force less the object's own at that deflection, 0.1 s from the touch
  double peak_force = 0.0, over_limit = -trial::kInfinite;  // N, m: PressFigures
  std::int32_t contacts = 0;                                // of the core
  std::int32_t bounces = 0,
               long_bounces = 0;  // losses of contact regained within 0.2 s; losses of 20 ms or more
};

// The change of the tool, judged by the tool that is truly in the hand.
struct ToolChange {
  double taken_at = kUnset;   // s: the hand holds the new tool
  double shown_at = kUnset;   // s: the overlay shows the new tool
  double miss = kUnset;       // m, of the first press with the new tool: PressFigures
  std::int64_t mistaken = 0;  // ticks of touch in which the overlay's tool differs from the hand's
};

class SessionMeasure {
 public:
  explicit SessionMeasure(const models::Setup& setup) : presses_(setup) {}
  void see(const trial::Glance& glance);
  // All presses that have begun, the figures of PressMeasure filled in.
  [[nodiscard]] std::vector<SessionPress> presses() const;
  [[nodiscard]] ToolChange change() const;
  [[nodiscard]] double tension() const { return presses_.greatest_tension(); }  // N
  [[nodiscard]] std::int64_t beyond_machine() const { return beyond_; }         // ticks beyond its limits
  [[nodiscard]] std::int64_t holds() const { return holds_; }                   // ticks in hold
  [[nodiscard]] std::uint32_t hold_reasons() const { return hold_reasons_; }
  [[nodiscard]] std::int64_t ticks() const { return ticks_; }

 private:
  void see_command(const trial::Glance& glance);
  void see_press(const trial::Glance& glance);
  void see_touch(const trial::Glance& glance, SessionPress& press, const Object& object);
  void see_change(const trial::Glance& glance);

  trial::PressMeasure presses_;
  std::vector<SessionPress> seen_;
  ToolChange change_;
  double touched_at_ = kUnset, lost_at_ = kUnset;  // s
  bool touching_ = false;
  std::int32_t held_before_ = -1,
               taken_ = -1;  // the last tool in the hand, and the tool that replaced it
  Point<'R'> command_;
  Vec3 command_velocity_ = Vec3::Zero();
  std::int64_t beyond_ = 0, holds_ = 0, ticks_ = 0;
  std::uint32_t hold_reasons_ = 0;
};

}  // namespace enc::bench::session
