#include "trial/measure/finger_measure.h"

#include <algorithm>
#include <cmath>

#include "core/control/stages/step_context.h"

namespace enc::trial {

void LineFit::add(double depth, double force) {
  ++n;
  x += depth;
  y += force;
  xx += depth * depth;
  xy += depth * force;
  yy += force * force;
}

double LineFit::slope() const {
  const auto count = static_cast<double>(n);
  return n < 2 ? kUnset : (count * xy - x * y) / (count * xx - x * x);
}

double LineFit::r2() const {
  const auto count = static_cast<double>(n);
  const double sxy = count * xy - x * y;
  return n < 3 ? kUnset : sxy * sxy / ((count * xx - x * x) * (count * yy - y * y));
}

TrueDepth true_depth(const Glance& glance) {
  const std::int32_t index = glance.out.object;
  if (index < 0 || !glance.truth.tool_tip.finite()) return {};
  const Object& object = glance.scene.objects[static_cast<std::size_t>(index)];
  const stages::NearestInWorld at = stages::nearest(object, glance.truth.tool_tip);
  const Interaction kind = object.interaction.kind;
  const bool gone = kind == Interaction::hit || kind == Interaction::shift;  // it has left its start
  return {gone ? kUnset : glance.truth.tool_radius - at.distance, at.normal,
          glance.truth.tool_tip - glance.truth.tool_radius * at.normal};
}

double FingerMeasure::tangential_share() const { return normal_ > 0.0 ? tangential_ / normal_ : kUnset; }

bool FarWatch::see(const Glance& glance) {
  constexpr double kSettled = 1.0;  // s until an unused arm must stand still
  const double now = seconds(glance.truth.t.time_since_epoch());
  const Mode before = mode_;
  mode_ = glance.out.mode;
  if (mode_ != before && mode_ == Mode::away) since_ = now;
  if (mode_ == Mode::away && now - since_ > kSettled)
    speed_ = std::max(speed_, glance.truth.tip_velocity.norm());
  return mode_ == Mode::follow && before == Mode::away;
}

void FingerMeasure::see(const Glance& glance) {
  way_.make_room();  // allocates in the first tick only
  const double now = seconds(glance.truth.t.time_since_epoch());
  if (far_.see(glance)) {
    meetings_.push_back({});
    meetings_.back().prepared = now;
    way_.clear();
  }
  if (meetings_.empty() || glance.out.mode == Mode::away) return;
  watch_meeting(glance, now);
  watch_force(glance);
}

PropTarget wanted_at(const Object& object, const Point<'W'>& tip) {
  const stages::NearestInWorld at = stages::nearest(object, tip);
  const Point<'W'> point = object.met_in_its_middle() ? object.X_WO.origin() : at.point;
  return {point, at.normal, at.distance};
}

void FingerMeasure::watch_meeting(const Glance& glance, double now) {
  constexpr double kThere = 2e-3;  // m
  FingerEncounter& meeting = meetings_.back();
  const TrueDepth at = true_depth(glance);
  if (std::isnan(meeting.touched)) {
    meeting.object = glance.out.object;
    meeting.approach_speed = glance.truth.approach_speed;
    way_.add(glance.truth.tip);
  }
  if (!glance.truth.touching || !at.normal.finite()) return;
  if (std::isnan(meeting.touched)) {
    meeting.touched = now;
    const Vec3 apart = (at.touching - glance.truth.tip).e();
    const Vec3 n = at.normal.e();
    meeting.miss = (apart - n.dot(apart) * n).norm();
    const Object& object = glance.scene.objects[static_cast<std::size_t>(meeting.object)];
    const Point<'W'> met = wanted_at(object, glance.truth.tool_tip).point;
    if (const std::size_t there = way_.there(met, kThere); there > 0)
      meeting.arrived = now - glance.scene.dt * static_cast<double>(there - 1);
  }
  meeting.peak_depth = std::fmax(meeting.peak_depth, at.depth);
}

void FingerMeasure::watch_force(const Glance& glance) {
  constexpr double kFelt = 1.0;                // N
  constexpr double kFrom = 2e-3, kTo = 10e-3;  // m
  FingerEncounter& meeting = meetings_.back();
  const TrueDepth at = true_depth(glance);
  if (std::isnan(meeting.touched) || !at.normal.finite()) {
    last_force_ = kUnset;
    return;
  }
  const double force = -dot(glance.truth.contact_force, at.normal);
  const bool pressed =
      glance.out.mode == Mode::contact && (std::isnan(at.depth) ? glance.truth.touching : at.depth > 0.0);
  if (pressed && !glance.truth.touching) ++meeting.breaks;
  meeting.peak_force = std::max(meeting.peak_force, force);
  if (pressed && !std::isnan(last_force_))
    meeting.greatest_step = std::max(meeting.greatest_step, std::abs(force - last_force_));
  last_force_ = force;
  if (!pressed) return;
  // The law is a force over the depth of the device. The finger is deeper, by what its pad yields.
  const double prop = at.depth + dot(at.touching - glance.truth.tip, at.normal);
  if (prop >= kFrom && prop <= kTo) {
    fit_.add(prop, force);
    believed_.add(glance.out.deflection, force);
  }
  if (force < kFelt) return;
  tangential_ += (glance.truth.contact_force + force * at.normal).norm();
  normal_ += force;
}

}  // namespace enc::trial
