#include "benchmarks/session/session_measure.h"

#include <algorithm>
#include <cmath>

#include "core/control/stages/step_context.h"

namespace enc::bench::session {
namespace {

constexpr double kImpactTime = 0.1;  // s from the first touch
constexpr double kBounceTime = 0.2;  // s: a later touch is a new touch
constexpr double kLong = 0.02;       // s: a shorter loss is a rattle of two hard tips

double time_of(const sim::Truth& truth) { return seconds(truth.t.time_since_epoch()); }

}  // namespace

// Checks each set-point against the machine's limits of speed, acceleration and reach.
void SessionMeasure::see_command(const trial::Glance& glance) {
  const Point<'R'> command = glance.out.manipulator.tip.origin();
  if (command_.finite()) {
    const double dt = glance.scene.dt;
    const Vec3 velocity = (command - command_).e() / dt;
    const double acceleration = (velocity - command_velocity_).norm() / dt;
    const Reach& reach = glance.scene.reach;
    constexpr double kRounding = 1e-6;  // rounding of a difference of set-points
    const bool within = velocity.norm() <= reach.speed * (1.0 + kRounding) &&
                        acceleration <= reach.acceleration * (1.0 + kRounding) &&
                        reach.contains(glance.out.manipulator.tip);
    if (!within) ++beyond_;
    command_velocity_ = velocity;
  }
  command_ = command;
  ++ticks_;
  if (glance.out.mode != Mode::hold) return;
  ++holds_;
  hold_reasons_ |= glance.out.why & kHoldReasons;
}

void SessionMeasure::see_touch(const trial::Glance& glance, SessionPress& press, const Object& object) {
  const sim::Truth& truth = glance.truth;
  const double now = time_of(truth);
  if (truth.touching && !touching_) {
    if (std::isnan(touched_at_)) touched_at_ = now;
    const double lost = now - lost_at_;  // NaN before the first loss
    if (lost <= kBounceTime) ++press.bounces;
    if (lost <= kBounceTime && lost >= kLong) ++press.long_bounces;
  }
  if (!truth.touching && touching_) lost_at_ = now;
  touching_ = truth.touching;
  if (!truth.touching || !(now - touched_at_ <= kImpactTime)) return;
  const stages::NearestInWorld at = stages::nearest(object, truth.tip);
  const double deflection = std::clamp(-(at.distance + truth.tip_radius), 0.0, object.limit);
  const double force = -dot(truth.contact_force, at.normal);
  press.impact = std::fmax(press.impact, force - object.response.press(deflection));
}

void SessionMeasure::see_press(const trial::Glance& glance) {
  const sim::Truth& truth = glance.truth;
  if (truth.phase == sim::Phase::approach && seen_.size() <= static_cast<std::size_t>(truth.press)) {
    seen_.resize(static_cast<std::size_t>(truth.press) + 1);
    seen_.back().aborted = truth.aborted;
    seen_.back().tool = truth.tool;
    touched_at_ = lost_at_ = kUnset;
    touching_ = false;
  }
  if (seen_.empty() || truth.tool < 0) return;
  SessionPress& press = seen_.back();
  const Object& object = glance.scene.objects.front();
  const stages::NearestInWorld at = stages::nearest(object, truth.tool_tip);
  const double gap = at.distance - truth.tool_radius;
  if (truth.phase != sim::Phase::wait && truth.phase != sim::Phase::change) {
    if (gap <= 0.0 && std::isnan(press.touch_speed)) press.touch_speed = truth.tool_velocity.norm();
    if (gap < press.nearest) {
      press.nearest = gap;
      press.normal = at.normal.e();
    }
  }
  see_touch(glance, press, object);
}

void SessionMeasure::see_change(const trial::Glance& glance) {
  const sim::Truth& truth = glance.truth;
  if (truth.touching && truth.tool >= 0 && glance.out.view.tool != truth.tool) ++change_.mistaken;
  if (truth.tool < 0) return;
  if (held_before_ >= 0 && truth.tool != held_before_) {
    change_.taken_at = time_of(truth);
    taken_ = truth.tool;
  }
  held_before_ = truth.tool;
  if (taken_ >= 0 && std::isnan(change_.shown_at) && glance.out.view.tool == taken_)
    change_.shown_at = time_of(truth);
}

ToolChange SessionMeasure::change() const {
  ToolChange change = change_;
  for (const SessionPress& press : presses())
    if (press.tool == taken_ && !press.aborted && std::isnan(change.miss)) change.miss = press.miss;
  return change;
}

void SessionMeasure::see(const trial::Glance& glance) {
  see_command(glance);
  see_press(glance);
  see_change(glance);
  presses_.see(glance);
}

std::vector<SessionPress> SessionMeasure::presses() const {
  std::vector<SessionPress> all = seen_;
  for (std::size_t i = 0; i < std::min(all.size(), presses_.presses().size()); ++i) {
    const trial::PressFigures& figures = presses_.presses()[i];
    all[i].miss = figures.miss;
    all[i].delay = figures.first_force_delay;
    all[i].contacts = figures.contacts;
    all[i].peak_force = figures.peak_force;
    all[i].over_limit = figures.over_limit;
  }
  return all;
}

}  // namespace enc::bench::session
