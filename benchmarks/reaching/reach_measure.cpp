#include "benchmarks/reaching/reach_measure.h"

#include <algorithm>
#include <cmath>

#include "core/task/walk.h"

namespace enc::bench::reaching {
namespace {

constexpr double kThere = 2e-3;    // m
constexpr double kImpact = 0.050;  // s

double along_surface(const trial::Wanted& at, const Point<'W'>& tip) {
  const Vec3 apart = (at.point - tip).e();
  const Vec3 n = at.normal.e();
  return (apart - n.dot(apart) * n).norm();
}

}  // namespace

std::vector<ReachOutcome> ReachMeasure::reaches() const {
  std::vector<ReachOutcome> all = over_;
  if (begun_) all.push_back(now_);
  return all;
}

void ReachMeasure::begin(const trial::Glance& glance) {
  if (begun_) over_.push_back(now_);
  begun_ = true;
  now_ = ReachOutcome{};
  now_.aim = glance.truth.aim;
  now_.aborted = glance.truth.aborted;
  contacts_before_ = glance.out.contacts;
}

void ReachMeasure::see(const trial::Glance& glance) {
  const double now = seconds(glance.truth.t.time_since_epoch());
  const sim::Phase phase = glance.truth.phase;
  // The core sees a finger go late: what it counts until the next reach begins is of this one.
  if (phase == sim::Phase::approach && phase_ != phase) begin(glance);
  phase_ = phase;
  const bool prepares = far_.see(glance);
  if (!begun_) return;
  now_.contacts = glance.out.contacts - contacts_before_;
  if (prepares) ++now_.prepares;
  if (std::isnan(now_.met)) {
    if (prepares) {
      now_.prepared = now;
      way_.clear();
    }
    way_.push_back(glance.truth.tip);
    meet(glance, now);
  } else {
    watch_contact(glance, now);
  }
}

void ReachMeasure::meet(const trial::Glance& glance, double now) {
  const sim::Truth& truth = glance.truth;
  const trial::Wanted at =
      trial::wanted_at(glance.scene.objects[static_cast<std::size_t>(now_.aim)], truth.tool_tip);
  if (!truth.touching && at.distance > truth.tool_radius) return;
  now_.met = now;
  now_.chosen = glance.out.object;
  now_.speed = truth.tool_velocity.norm();
  now_.miss = along_surface(at, truth.tip);
  const std::size_t there = trial::there_since(way_, at.point, kThere);
  if (there < way_.size() && !std::isnan(now_.prepared))
    now_.arrived = now - glance.scene.dt * static_cast<double>(way_.size() - 1 - there);
  watch_contact(glance, now);
}

void ReachMeasure::watch_contact(const trial::Glance& glance, double now) {
  const sim::Truth& truth = glance.truth;
  if (!truth.touching) return;
  now_.touched = true;
  const trial::Wanted at =
      trial::wanted_at(glance.scene.objects[static_cast<std::size_t>(now_.aim)], truth.tool_tip);
  if (now - now_.met <= kImpact) now_.impact = std::max(now_.impact, -dot(truth.contact_force, at.normal));
  if (truth.phase == sim::Phase::hold)
    now_.slide_error = std::max(now_.slide_error, along_surface(at, truth.tip));
}

}  // namespace enc::bench::reaching
