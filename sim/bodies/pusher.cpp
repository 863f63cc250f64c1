#include "sim/bodies/pusher.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/control/track/reach.h"

namespace enc::sim {
namespace {

constexpr double kClear = 2e-3;  // m above the surface, the waiting position

}  // namespace

Pusher::Pusher(const PusherSpec& spec, const PusherTruth& truth, const PushedPoint& to, double tip_radius,
               std::uint64_t seed)
    : spec_(spec), truth_(truth), to_(to), tip_radius_(tip_radius) {
  state_.noise = Stream(seed, "pusher");
  for (double& part : state_.tremor) part = truth.tremor * state_.noise.normal();
}

double Pusher::phase_time() const {
  if (done()) return std::numeric_limits<double>::infinity();
  if (state_.phase == Phase::wait) return spec_.rest_time;
  return state_.phase == Phase::hold ? spec_.hold_time : spec_.ramp_time;
}

double Pusher::duration() const {
  return static_cast<double>(spec_.repeats) * (spec_.rest_time + 2.0 * spec_.ramp_time + spec_.hold_time) +
         spec_.rest_time;
}

Pusher::Intent Pusher::intent(double since) const {
  const double way = reach() + kClear;
  const MinimumJerk ramp(since / spec_.ramp_time);
  const double speed = way * ramp.v / spec_.ramp_time;
  switch (state_.phase) {
    case Phase::press:
      return {way * ramp.x - kClear, speed};
    case Phase::hold:
      return {reach(), 0.0};
    case Phase::release:
      return {reach() - way * ramp.x, -speed};
    default:
      return {-kClear, 0.0};
  }
}

void Pusher::next_phase(double t) {
  state_.phase_start = t;
  switch (state_.phase) {
    case Phase::wait:
      state_.phase = Phase::press;
      break;
    case Phase::press:
      state_.phase = Phase::hold;
      break;
    case Phase::hold:
      state_.phase = Phase::release;
      break;
    default:
      state_.phase = Phase::wait;
      ++state_.push;
  }
}

// Narrow-band noise: a phasor that turns at the tremor's rate and decorrelates within a second.
double Pusher::tremble(double h) {
  constexpr double kMemory = 1.0;  // s
  const double angle = 2.0 * std::numbers::pi * truth_.tremor_rate * h;
  const double keep = std::exp(-h / kMemory);
  const double fresh = truth_.tremor * std::sqrt(1.0 - keep * keep);
  const double c = keep * std::cos(angle), s = keep * std::sin(angle);
  const double a = state_.tremor[0], b = state_.tremor[1];
  state_.tremor[0] = c * a - s * b + fresh * state_.noise.normal();
  state_.tremor[1] = s * a + c * b + fresh * state_.noise.normal();
  return state_.tremor[0];
}

bool Pusher::near(double t, double h, double ahead) const {
  if (done() || state_.phase != Phase::wait) return false;
  const double left = state_.phase_start + spec_.rest_time - std::min(ahead, spec_.rest_time - h) - t;
  return left > 0.5 * h && left <= 1.5 * h;  // true for exactly one step, whatever the rounding
}

Vec<'W'> Pusher::act(double t, double h, const Point<'W'>& tip, const Vec<'W'>& velocity) {
  while (t + h - state_.phase_start >= phase_time()) next_phase(state_.phase_start + phase_time());
  const Intent wanted = intent(t + h - state_.phase_start);
  const double x = dot(to_.at.point - tip, to_.at.normal) - tip_radius_;
  const double v = -dot(velocity, to_.at.normal);
  const double tremor = tremble(h);
  const bool pushing = state_.phase != Phase::wait;
  const double pushed = truth_.stiffness * (wanted.x - x) + truth_.damping * (wanted.v - v) + tremor;
  state_.force = pushing ? std::max(0.0, pushed) : 0.0;
  return -state_.force * to_.at.normal;
}

}  // namespace enc::sim
