#include "core/control/task/admittance/damping.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/machine/loop_model.h"

namespace enc {
namespace {

constexpr double kPi = std::numbers::pi;

// Everything that delays a small motion: filter, servo, dead time, and the command limiter, which covers half
// of the distance in a tick.
double lag_of(const LoopModel& loop, double dt) {
  return 1.0 / (2.0 * kPi * loop.filter_hz) + 2.0 * loop.servo_damping / (2.0 * kPi * loop.servo_hz) +
         loop.delay + 2.0 * dt;
}

}  // namespace

DampingLaw::DampingLaw(const AdmittanceRig& rig, const LoopModel& loop, double gain, double acceleration,
                       double dt)
    : rig_(rig),
      hand_stiffness_(loop.hand_stiffness),
      stable_slope_(lowest_stable_stiffness(loop)),
      lag_(lag_of(loop, dt)),
      acceleration_(acceleration),
      dt_(dt),
      filter_{gain, 1.0 - std::exp(-2.0 * kPi * rig.slowest * dt), 1.0 - std::exp(-dt / rig.average_time)},
      calm_(std::exp(-dt / rig.calm_time)) {}

Swing DampingLaw::begin(double slope, double force, double depth) const noexcept {
  Swing swing;
  swing.depth = swing.slow_depth = depth;
  swing.slow_force = force;
  swing.stiffness = slope < stable_slope_ ? hand_stiffness_ : 0.0;
  return swing;
}

void SwingFilter::operator()(Swing& swing, double force, double depth) const noexcept {
  swing.depth += low * (depth - swing.depth);
  swing.slow_force += slow * (force - swing.slow_force);
  swing.slow_depth += slow * (swing.depth - swing.slow_depth);
  const double change = force - swing.slow_force;
  const double move = swing.move();
  swing.exchanged += average * (-change * move - swing.exchanged);
  swing.moved += average * (move * move - swing.moved);
}

double DampingLaw::observe(Swing& swing, double force, double depth) const noexcept {
  filter_(swing, force, depth);
  const double seen = swing.exchanged / (swing.moved + rig_.least_swing * rig_.least_swing);
  swing.stiffness = std::max(seen, calm_ * swing.stiffness);
  // A wide oscillation makes the machine lag by the time that the distance takes at its acceleration, there
  // and back to rest.
  const double wide = 2.0 * std::sqrt(std::sqrt(2.0 * swing.moved) / acceleration_);
  return std::min(rig_.most_damping, rig_.margin * (2.0 / kPi) * (lag_ + wide) * swing.stiffness);
}

double DampingLaw::carry(const Response& response, const ResponseState& at, double carried, double pressed,
                         double damping, double most) const noexcept {
  if (!(damping > 0.0)) return pressed;
  ResponseState end = at;
  // the object does not move beyond its limit
  const double reached = std::min(pressed, response.force(end, most));
  ResponseState undamped = at;
  const double way = response.deflection(undamped, reached, most) - at.deflection;
  const double slope = (reached - carried) / way;
  if (!(slope > 0.0) || !std::isfinite(slope)) return pressed;  // no motion, nothing to damp
  // Implicit, with the chord of the object's curve: exact for a spring, never beyond the undamped answer.
  return carried + (pressed - carried) * slope * dt_ / (damping + slope * dt_);
}

}  // namespace enc
