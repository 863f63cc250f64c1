#include "trial/measure/touch_measure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace enc::trial {

// Waiting belongs to the press before.
void PlanMeasure::begin(const Glance& glance) {
  const sim::Truth& truth = glance.truth;
  if (truth.phase == sim::Phase::wait || truth.phase == sim::Phase::change || truth.press == press_) return;
  press_ = truth.press;
  tries_ = !truth.aborted;
  if (!tries_) return;
  tried_.emplace_back();
  tried_.back().began = seconds(truth.t.time_since_epoch());
}

void PlanMeasure::see(const Glance& glance) {
  const sim::Truth& truth = glance.truth;
  if (!glance.simulated || truth.press < 0) return;
  begin(glance);
  const std::int32_t more = glance.out.contacts - contacts_;
  contacts_ = glance.out.contacts;
  if (!tries_) return;
  PressAttempt& now = tried_.back();
  now.contacts += more;
  now.pressed = now.pressed || truth.phase == sim::Phase::hold || truth.phase == sim::Phase::release ||
                truth.phase == sim::Phase::retreat;
  if (truth.touching && std::isnan(now.touched)) now.touched = seconds(truth.t.time_since_epoch());
}

namespace {

constexpr double kSlowest = 1.0;  // Hz: slower changes are the user's own
constexpr double kAverage = 0.3;  // s

}  // namespace

void TouchMeasure::see(const Glance& glance) {
  plan_.see(glance);
  see_contact(glance);
  if (glance.family.takes_force) return see_motors(glance);
  if (glance.out.mode == Mode::hold) return forget_swing();
  const bool known = glance.in.tip.value.X_RH.valid() && glance.out.force.finite();
  if (known && glance.out.first_touch.finite()) see_swing(glance);
}

void TouchMeasure::see_motors(const Glance& glance) {
  constexpr double kAtOnce = 0.020;  // s: an impact is shorter
  const double dt = glance.scene.dt;
  const auto see = [&](LimitAction& limit, std::uint32_t why) {
    limit.now = (glance.out.why & why) != 0 ? limit.now + dt : 0.0;
    if (limit.now < kAtOnce) return;
    if (std::isnan(limit.first)) limit.first = seconds(glance.tick.t.time_since_epoch()) - limit.now;
    limit.total += limit.now - dt < kAtOnce ? limit.now : dt;
  };
  see(peak_, kOverload);
  see(heat_, kHot);
}

// A hold within a contact does not split it.
void TouchMeasure::see_contact(const Glance& glance) {
  if (glance.out.mode == Mode::hold) return;
  const bool touching = glance.out.mode == Mode::contact;
  if (touching_ && (!touching || glance.out.contacts != contact_.number)) end_contact(glance);
  if (touching && !touching_) {
    contact_ = Contact{};
    contact_.number = glance.out.contacts;
    contact_.began = seconds(glance.tick.t.time_since_epoch());
  }
  if (!touching) return;
  const double force = -glance.out.force.xyz[2];
  contact_.lasted += glance.scene.dt;
  contact_.touched = contact_.touched || glance.truth.touching;
  contact_.felt = contact_.felt || force > glance.scene.force.contact;
  contact_.told = contact_.told || !glance.in.withheld;
  if (std::isfinite(force)) contact_.pushed += force * glance.scene.dt;
  touching_ = true;
}

// An arm measures no force: its contacts are the core's estimates. The next pictures correct a wrong
// estimate. So a contact shorter than the allowed loss of tracking is late data, not an empty contact.
void TouchMeasure::end_contact(const Glance& glance) {
  touching_ = false;
  const bool arm = glance.family.takes_force;
  if (arm && contact_.lasted < glance.scene.tracker.lost_age) return;
  const bool believed = arm ? !contact_.told || contact_.pushed > kHidden * contact_.lasted : contact_.felt;
  if (glance.simulated ? !contact_.touched : !believed) empty_.push_back(contact_.began);
}

// Neither a hold nor the time before it counts as an oscillation.
void TouchMeasure::forget_swing() {
  if (!swings_.empty() && swings_.back().from == now_.from) swings_.pop_back();
  swing_ = Swing{};
  now_ = SwingFigures{};
  away_ = kTime;
}

void TouchMeasure::filter_swing(const Glance& glance, double force) {
  const double dt = glance.scene.dt;
  const double depth =
      (glance.scene.X_WR * glance.in.tip.value.X_RH.origin() - glance.out.first_touch).e().norm();
  if (std::isnan(swing_.depth)) {
    swing_ = Swing{};
    swing_.depth = swing_.slow_depth = depth;
    swing_.slow_force = force;
    last_move_ = 0.0;
  }
  const SwingFilter filter{glance.scene.filter_gain, 1.0 - std::exp(-2.0 * std::numbers::pi * kSlowest * dt),
                           1.0 - std::exp(-dt / kAverage)};
  filter(swing_, force, depth);
}

// An oscillation that dies out soon is not a limit cycle.
void TouchMeasure::end_swing(double t) {
  const bool told = !swings_.empty() && swings_.back().from == now_.from;
  if (told && touching_ && t - now_.from < kLong) swings_.pop_back();
  now_ = SwingFigures{};
}

// A large oscillation leaves the contact and returns to it.
void TouchMeasure::see_swing(const Glance& glance) {
  const Outputs& out = glance.out;
  const double dt = glance.scene.dt;
  away_ = touching_ ? 0.0 : away_ + dt;
  if (away_ > kTime) {
    swing_ = Swing{};
    now_ = SwingFigures{};
    return;
  }
  const double force = std::max(0.0, -out.force.xyz[2]);
  filter_swing(glance, force);
  const double move = swing_.move();
  const double way = 2.0 * std::sqrt(2.0 * swing_.moved);
  const double t = seconds(glance.tick.t.time_since_epoch());
  if (!(swing_.exchanged > 0.0) || way < kWay) {
    end_swing(t);
    return;
  }
  if (std::isnan(now_.from)) {
    now_.from = t;
    now_.object = out.object;
    turns_ = 0;
    pressed_ = false;
  }
  if (move * last_move_ < 0.0) ++turns_;
  last_move_ = move;
  pressed_ = pressed_ || (touching_ && force > glance.scene.force.contact);
  now_.until = t;
  now_.way = std::max(now_.way, way);
  if (t - now_.from < kTime) return;
  now_.frequency = 0.5 * static_cast<double>(turns_) / (t - now_.from);
  if (turns_ < kTurns || now_.frequency < kSlowest || !pressed_) return;
  if (swings_.empty() || swings_.back().from != now_.from)
    swings_.push_back(now_);
  else
    swings_.back() = now_;
}

}  // namespace enc::trial
