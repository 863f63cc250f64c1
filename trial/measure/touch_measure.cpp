#include "trial/measure/touch_measure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace enc::trial {
namespace {

constexpr double kSlowest = 1.0;  // Hz: slower changes are the user's own
constexpr double kAverage = 0.3;  // s

}  // namespace

void TouchMeasure::see(const Glance& glance) {
  if (glance.scene.impedance) see_motors(glance);
  if (glance.scene.impedance || glance.out.mode == Mode::hold) return;
  see_force(glance);
  const bool known = glance.in.tip.value.X_RH.valid() && glance.out.force.finite();
  if (known && glance.out.first_touch.finite()) see_swing(glance);
}

void TouchMeasure::see_motors(const Glance& glance) {
  constexpr double kAtOnce = 0.020;  // s: an impact is over sooner
  const double dt = glance.scene.dt;
  const auto see = [&](Acted& limit, std::uint32_t why) {
    limit.now = (glance.out.why & why) != 0 ? limit.now + dt : 0.0;
    if (limit.now < kAtOnce) return;
    if (std::isnan(limit.first)) limit.first = seconds(glance.tick.t.time_since_epoch()) - limit.now;
    limit.total += limit.now - dt < kAtOnce ? limit.now : dt;
  };
  see(peak_, kOverload);
  see(heat_, kHot);
}

void TouchMeasure::see_force(const Glance& glance) {
  const bool touching = glance.out.mode == Mode::contact;
  if (touching && !touching_) {
    felt_ = false;
    began_ = seconds(glance.tick.t.time_since_epoch());
  }
  if (!touching && touching_ && !felt_) empty_.push_back(began_);
  touching_ = touching;
  felt_ = felt_ || -glance.out.force.xyz[2] > glance.scene.force.contact;
}

// A wide swing leaves the contact and comes back to it.
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
  const double depth = (glance.scene.X_WR * glance.in.tip.value.X_RH.origin() - out.first_touch).e().norm();
  if (std::isnan(swing_.depth)) {
    swing_ = Swing{};
    swing_.depth = swing_.slow_depth = depth;
    swing_.slow_force = force;
    last_move_ = 0.0;
  }
  const SwingFilter filter{glance.scene.filter_gain, 1.0 - std::exp(-2.0 * std::numbers::pi * kSlowest * dt),
                           1.0 - std::exp(-dt / kAverage)};
  filter(swing_, force, depth);
  const double move = swing_.move();
  const double way = 2.0 * std::sqrt(2.0 * swing_.moved);
  const double t = seconds(glance.tick.t.time_since_epoch());
  if (!(swing_.exchanged > 0.0) || way < kWay) {
    // What dies out soon is no swing that the loop keeps up.
    const bool told = !swings_.empty() && swings_.back().from == now_.from;
    if (told && touching_ && t - now_.from < kLong) swings_.pop_back();
    now_ = SwingFigures{};
    return;
  }
  if (std::isnan(now_.from)) {
    now_.from = t;
    now_.object = out.object;
    turns_ = 0;
  }
  if (move * last_move_ < 0.0) ++turns_;
  last_move_ = move;
  now_.until = t;
  now_.way = std::max(now_.way, way);
  if (t - now_.from < kTime) return;
  now_.frequency = 0.5 * static_cast<double>(turns_) / (t - now_.from);
  if (swings_.empty() || swings_.back().from != now_.from)
    swings_.push_back(now_);
  else
    swings_.back() = now_;
}

}  // namespace enc::trial
