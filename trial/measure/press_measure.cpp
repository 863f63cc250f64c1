#include "trial/measure/press_measure.h"

#include <algorithm>
#include <cmath>

#include "core/control/stages/step_context.h"
#include "core/spec/user_spec.h"
#include "sim/plants/tracker_plant.h"

namespace enc::trial {
namespace {

// Errors of a resting tip, m: inset, registration, and three sigma of the tracker.
double still_error(const models::Setup& setup) {
  const sim::TwinSpec& twin = setup.twin;
  double noise = twin.tracker.noise.norm();
  for (const ToolSpec& tool : setup.scene.tools)
    noise = std::max(noise, sim::with_tool_known(twin.tracker, tool.markers, tool.tip).noise.norm());
  return setup.scene.follow.inset + twin.tracker.bias.norm() + 3.0 * noise;
}

// Largest age of the data that the tip acts on, s: a frame, a server slot and its processing, three times the
// mean network delay, cycles, servo.
double greatest_age(const models::Setup& setup) {
  const sim::TwinSpec& twin = setup.twin;
  return 1.0 / twin.tracker.rate + twin.tracker.latency + 1.0 / twin.tracker.server_rate +
         twin.tracker.process + 3.0 * twin.tracker.udp_delay +
         (static_cast<double>(twin.hexapod.delay_cycles) + 2.0) / setup.rig.loop.rate +
         2.0 * twin.hexapod.damping / (2.0 * M_PI * twin.hexapod.servo);
}

IdealFollower follower(const models::Setup& setup, IdealFollower::Sees sees) {
  constexpr double kOldest = 1.0;  // s: older data are useless, and each tick up to it is stored
  return {sees, std::min(greatest_age(setup), kOldest), setup.rig.manipulator.speed,
          stages::kSideShare * setup.rig.manipulator.acceleration, 1.0 / setup.rig.loop.rate};
}

// True if the plan gives each press its own path.
bool drawn(const models::Setup& setup) {
  return setup.scene.user && setup.scene.user->kind != UserKind::press_release;
}

}  // namespace

PressMeasure::PressMeasure(const models::Setup& setup)
    : setup_(setup),
      takes_force_(family_of(setup).takes_force),
      follows_(drawn(setup) && !takes_force_),
      followers_{follower(setup, IdealFollower::Sees::held),
                 follower(setup, IdealFollower::Sees::carried_on)} {}

double SquareMean::root() const { return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : kUnset; }

double miss_bound(const models::Setup& setup, double approach_speed) {
  const RigSpec& rig = setup.rig;
  const double tilt = setup.scene.user ? setup.scene.user->approach_tilt : 0.0;
  const double sideways = approach_speed * std::sin(tilt);
  const double followed = std::min(sideways, rig.manipulator.speed);
  const double braking = followed * followed / (2.0 * stages::kSideShare * rig.manipulator.acceleration);
  const double from = setup.scene.user ? setup.scene.user->approach_from : 0.0;
  const double outrun = (sideways - followed) / std::max(approach_speed, 1e-9) * from;
  return still_error(setup) + sideways * greatest_age(setup) + braking + outrun;
}

double response_lag(const RigSpec& rig) {
  const double servo = 2.0 * rig.manipulator.servo_damping / (2.0 * M_PI * rig.manipulator.servo);
  return 1.0 / (2.0 * M_PI * rig.force.filter) + servo + rig.manipulator.delay + 2.0 / rig.loop.rate;
}

// Measures the distance of the haptic-tip when the tool's tip crosses the undeformed surface.
void PressMeasure::meet(const Glance& glance, PressFigures& press, const Vec3& normal, double tool_gap) {
  if (std::isnan(press.miss) && tool_gap <= 0.0) {
    const Vec3 touching = glance.truth.tool_tip.e() - glance.truth.tool_radius * normal;
    const Vec3 touched = glance.truth.tip.e() + glance.truth.tip_radius * normal;
    press.miss = (touching - touched).norm();
    const Vec3 under = glance.truth.tool_tip.e() - (tool_gap + glance.truth.tool_radius) * normal;
    press.miss_bound = drawn(setup_) ? still_error(setup_) +
                                           std::max(followers_[0].behind(under), followers_[1].behind(under))
                                     : miss_bound(setup_, press.approach_speed);
    met_at_ = seconds(glance.truth.t.time_since_epoch());
  }
  if (std::isnan(press.first_force_delay) && !std::isnan(met_at_) && glance.truth.touching)
    press.first_force_delay = seconds(glance.truth.t.time_since_epoch()) - met_at_;
}

void PressMeasure::compare(const Glance& glance, PressFigures& press, const Object& object, double deflection,
                           double force) {
  if (glance.out.mode != Mode::contact || !glance.truth.touching) return;
  const double limit = object.limit_at(glance.out.contacts);
  press.object = glance.out.object;
  press.limit = limit;
  press.peak_force = std::max(press.peak_force, force);
  press.peak_deflection = std::max(press.peak_deflection, deflection);
  press.over_limit = std::max(press.over_limit, deflection - limit);
  const bool at_limit = deflection >= limit - near_limit(limit);
  if (at_limit && std::isnan(press.force_at_limit)) press.force_at_limit = force;
  reached_ = reached_ || at_limit;
  if (deflection <= 0.0 || at_limit) return;
  if (glance.truth.phase == sim::Phase::press && !reached_)
    press_error_.add(force - object.response.press(deflection));
  if (glance.truth.phase == sim::Phase::release)
    release_error_.add(force - object.response.release(deflection));
}

// The machine answers late, by filter and servo: to a force between the least and the most that these still
// hold. The object's force may lie anywhere between press and release curve. The core renders the object
// smaller by its skin, which matters for a stiff object.
void PressMeasure::judge_law(const Glance& glance, const Object& object, double deflection, double force) {
  const double pushed = glance.truth.touching ? force : 0.0;
  const double share = glance.scene.dt / (glance.scene.dt + response_lag(setup_.rig));
  least_ = std::min(pushed, least_ + share * (pushed - least_));
  most_ = std::max(pushed, most_ + share * (pushed - most_));
  const double limit = object.limit_at(glance.out.contacts);
  const bool judged =
      glance.out.mode == Mode::contact && glance.truth.touching && deflection < limit - near_limit(limit);
  const double depth = std::max(0.0, deflection), rendered = std::max(0.0, deflection - stages::kSkin);
  const auto [low, high] = std::minmax({object.response.press(rendered), object.response.release(rendered),
                                        object.response.press(depth), object.response.release(depth)});
  const double away = judged ? std::max(least_ - high, low - most_) : 0.0;
  if (!(away > kOff)) {
    off_ = Departure{};
    return;
  }
  const double now = seconds(glance.truth.t.time_since_epoch());
  if (std::isnan(off_.from)) off_.from = now;
  off_.lasted = now - off_.from;
  const double inset = glance.scene.follow.inset + stages::kSkin;
  if (low - most_ > kOff && deflection <= inset) off_.impulse += away * glance.scene.dt;
  if (away > off_.away) {
    off_.away = away;
    off_.force = force;
    off_.deflection = deflection;
  }
  if (off_.lasted < kLasting && off_.impulse < kOff * kLasting) return;
  if (departures_.empty() || departures_.back().from != off_.from) departures_.emplace_back();
  departures_.back() = off_;
}

// The press of a tick. A press begins with the approach; waiting belongs to the press before it.
PressFigures* PressMeasure::press_of(const sim::Truth& truth) {
  if (truth.phase != sim::Phase::wait && presses_.size() <= static_cast<std::size_t>(truth.press)) {
    presses_.resize(static_cast<std::size_t>(truth.press) + 1);
    presses_.back().approach_speed = truth.approach_speed;
    met_at_ = kUnset;
    reached_ = false;
  }
  return presses_.empty() ? nullptr : &presses_.back();
}

// A tip on its way into another object may be outside of it.
void PressMeasure::watch_outside(std::int32_t object, double deflection) {
  if (object != object_before_) entered_ = false;
  object_before_ = object;
  if (object < 0) return;
  entered_ = entered_ || deflection >= 0.0;
  if (entered_) greatest_outside_ = std::fmax(greatest_outside_, -deflection);
}

// Followers run only while the hand holds a tool, since the machine follows nothing otherwise.
void PressMeasure::follow(const Glance& glance) {
  const sim::Truth& truth = glance.truth;
  if (truth.tool < 0 || truth.aim < 0) return;
  const Object& aim = glance.scene.objects[static_cast<std::size_t>(truth.aim)];
  const Vec3 under = stages::nearest(aim, truth.tool_tip).point.e();
  for (IdealFollower& one : followers_) one.see(under);
}

void PressMeasure::see(const Glance& glance) {
  const sim::Truth& truth = glance.truth;
  if (!glance.simulated || truth.press < 0 || glance.scene.objects.empty()) return;
  if (follows_) follow(glance);
  const std::size_t index = glance.out.object >= 0 ? static_cast<std::size_t>(glance.out.object) : 0;
  const Object& object = glance.scene.objects[index];
  const stages::NearestInWorld at_tip = stages::nearest(object, truth.tip);
  const double deflection = -(at_tip.distance + truth.tip_radius);
  watch_outside(glance.out.object, deflection);
  // Pull acts along the line between the two tips, in either direction.
  if (truth.touching)
    greatest_tension_ = std::max(greatest_tension_,
                                 truth.contact_force.e().dot((truth.tool_tip - truth.tip).e().normalized()));
  const double power = dot(truth.contact_force, truth.tip_velocity);
  (power > 0.0 ? energy_in_ : energy_out_) += std::abs(power) * glance.scene.dt;

  if (PressFigures* press = press_of(truth)) {
    press->contacts += glance.out.contacts - contacts_before_;
    if (mode_before_ == Mode::restore && glance.out.mode == Mode::follow)
      press->restore_error = (truth.tip - buffered_).norm();
    const stages::NearestInWorld at_tool = stages::nearest(object, truth.tool_tip);
    meet(glance, *press, at_tool.normal.e(), at_tool.distance - truth.tool_radius);
    const double force = -dot(truth.contact_force, at_tip.normal);
    compare(glance, *press, object, deflection, force);
    if (!takes_force_) judge_law(glance, object, deflection, force);
  }
  contacts_before_ = glance.out.contacts;
  mode_before_ = glance.out.mode;
  buffered_ = glance.out.first_touch;
}

PressMeasure measured_run(const models::Setup& setup, std::uint64_t seed, double& simulated) {
  PressMeasure measure(setup);
  TrialOptions options;
  options.seed = seed;
  options.watch = [&](const Glance& glance) { measure.see(glance); };
  simulated += Trial(setup, options).run().simulated;
  return measure;
}

}  // namespace enc::trial
