#include "benchmarks/reaching/reach_measure.h"

#include <algorithm>
#include <cmath>

#include "core/base/rotation.h"
#include "core/control/stages/walk.h"

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
  take_picture(glance, now);
  if (std::isnan(now_.met)) {
    if (prepares) {
      now_.prepared = now;
      way_.clear();
    }
    way_.add(glance.truth.tip);
    meet(glance, now);
  } else {
    watch_contact(glance, now);
  }
}

// Pictures stay in W until it is known where they meet.
void ReachMeasure::take_picture(const trial::Glance& glance, double now) {
  const Stamped<TrackedTool>& told = glance.in.tool;
  if (!std::isnan(now_.met) || told.health != Health::ok || told.value.tool < 0 || told.t == newest_) return;
  newest_ = told.t;
  const Point<'T'>& tip = glance.scene.tools[static_cast<std::size_t>(told.value.tool)].tip.centre;
  const Point<'W'> at = glance.scene.X_WC * (told.value.X_CT * tip);
  now_.seen.pictures.push_back({at.e(), seconds(told.t.time_since_epoch()), now});
}

void ReachMeasure::meet(const trial::Glance& glance, double now) {
  const sim::Truth& truth = glance.truth;
  const trial::Wanted at =
      trial::wanted_at(glance.scene.objects[static_cast<std::size_t>(now_.aim)], truth.tool_tip);
  if (!truth.touching && at.distance > truth.tool_radius) return;
  now_.met = now;
  const Pose<'W', 'N'> X_WN(rotation_z_to(at.normal.e()), at.point + truth.tool_radius * at.normal);
  const Pose<'N', 'W'> X_NW = X_WN.inverse();
  for (SeenReach::Picture& picture : now_.seen.pictures) picture.at = (X_NW * Point<'W'>(picture.at)).e();
  now_.seen.met = now;
  now_.seen.where = (X_NW * truth.tool_tip).e().head<2>();
  now_.chosen = glance.out.object;
  now_.speed = truth.tool_velocity.norm();
  now_.miss = along_surface(at, truth.tip);
  const std::size_t there = way_.there(at.point, kThere);
  if (there > 0 && !std::isnan(now_.prepared))
    now_.arrived = now - glance.scene.dt * static_cast<double>(there - 1);
  watch_contact(glance, now);
}

void ReachMeasure::watch_contact(const trial::Glance& glance, double now) {
  const sim::Truth& truth = glance.truth;
  if (!truth.touching) return;
  now_.touched = true;
  const trial::Wanted at =
      trial::wanted_at(glance.scene.objects[static_cast<std::size_t>(now_.aim)], truth.tool_tip);
  if (now_.felt < 0 && glance.out.mode == Mode::contact) {
    now_.felt = glance.out.object;
    now_.felt_after = now - now_.met;
    now_.felt_depth = truth.tool_radius - at.distance;
  }
  if (now - now_.met <= kImpact) now_.impact = std::max(now_.impact, -dot(truth.contact_force, at.normal));
  if (truth.phase == sim::Phase::hold)
    now_.slide_error = std::max(now_.slide_error, along_surface(at, truth.tip));
}

}  // namespace enc::bench::reaching
