#include "core/track/predict.h"

#include <algorithm>
#include <cmath>

namespace enc {
namespace {

// A hand does not leap by more than this between two poses: another tool was taken for it, or it came back.
constexpr double kFastest = 5.0;  // m/s
constexpr double kLeap = 5e-3;    // m
// What is known of a tool that has just come into view.
constexpr double kSpeed = 0.3;         // m/s rms
constexpr double kAcceleration = 3.0;  // m/s^2 rms
// After the longest prediction the tip is thought to come to rest within this time (sources/tracking 5: 200
// ms in all).
constexpr double kSlowDown = 0.1;  // s

double square(double x) { return x * x; }

void begin(const TrackerRig& rig, std::int32_t tool, Time t, const Point<'W'>& tip, TipMotion& motion) {
  motion = {tool, t, tip, Vec<'W'>::zero(), Vec<'W'>::zero()};
  motion.xx = square(rig.measurement_noise);
  motion.vv = square(kSpeed);
  motion.aa = rig.prediction == Prediction::constant_acceleration ? square(kAcceleration) : 0.0;
}

// The time for which speed and acceleration may be carried on from a pose that is `old`, s.
double carried_on(const TrackerRig& rig, double old) {
  const double late = std::clamp(old - rig.longest_prediction, 0.0, kSlowDown);
  return std::clamp(old, 0.0, rig.longest_prediction) + late - 0.5 * late * late / kSlowDown;
}

// The state and its covariance h s later. White noise drives the acceleration (constant velocity) or the jerk
// (constant acceleration) [Bar-Shalom, Estimation with Applications, 6.2]; `noise` is its density.
void propagate(const TrackerRig& rig, double h, double noise, TipMotion& m) {
  m.position.e() += h * m.velocity.e() + 0.5 * h * h * m.acceleration.e();
  m.velocity.e() += h * m.acceleration.e();
  // P <- F P F', F = [1 h h^2/2; 0 1 h; 0 0 1], row by row.
  const double k = 0.5 * h * h;
  const double xx = m.xx + h * m.xv + k * m.xa;
  const double xv = m.xv + h * m.vv + k * m.va;
  const double xa = m.xa + h * m.va + k * m.aa;
  const double vv = m.vv + h * m.va;
  const double va = m.va + h * m.aa;
  m.xx = xx + h * xv + k * xa;
  m.xv = xv + h * xa;
  m.xa = xa;
  m.vv = vv + h * va;
  m.va = va;
  if (rig.prediction == Prediction::constant_velocity) {
    const double q = square(noise);
    m.xx += q * h * h * h / 3.0;
    m.xv += q * h * h / 2.0;
    m.vv += q * h;
  } else {
    const double q = square(noise);
    m.xx += q * h * h * h * h * h / 20.0;
    m.xv += q * h * h * h * h / 8.0;
    m.xa += q * h * h * h / 6.0;
    m.vv += q * h * h * h / 3.0;
    m.va += q * h * h / 2.0;
    m.aa += q * h;
  }
}

// A hand keeps its speed for long and then changes it at once: a pose that is farther off than four sigma is
// explained by as much acceleration as it takes, and not by noise [Bar-Shalom 11.2]. Of three axes together,
// noise alone is beyond four sigma once in 900 poses, beyond three once in 34: that would be in every tenth
// approach.
double surprised(const TrackerRig& rig, double h, const Vec3& innovation, const TipMotion& m) {
  constexpr double kSigmas = 4.0;
  const double s = m.xx + square(rig.measurement_noise);  // of each axis
  const double found = innovation.squaredNorm();
  if (rig.surprise_noise <= rig.acceleration_noise || found <= square(kSigmas) * s) return 0.0;
  const double needed = (found / 3.0 - s) * 3.0 / (h * h * h);  // q h^3 / 3 more makes s what was found
  return std::min(rig.surprise_noise, std::sqrt(square(rig.acceleration_noise) + needed));
}

void correct(const TrackerRig& rig, const Vec3& innovation, TipMotion& m) {
  const double s = m.xx + square(rig.measurement_noise);
  const double kx = s > 0.0 ? m.xx / s : 1.0;  // neither noise nor doubt: the pose is the truth
  const double kv = s > 0.0 ? m.xv / s : 0.0;
  const double ka = s > 0.0 ? m.xa / s : 0.0;
  m.position.e() += kx * innovation;
  m.velocity.e() += kv * innovation;
  m.acceleration.e() += ka * innovation;
  m.vv -= kv * m.xv;
  m.va -= kv * m.xa;
  m.aa -= ka * m.xa;
  m.xv *= 1.0 - kx;
  m.xa *= 1.0 - kx;
  m.xx *= 1.0 - kx;
}

}  // namespace

void observe(const TrackerRig& rig, std::int32_t tool, Time t, const Point<'W'>& tip, TipMotion& motion,
             bool calm) noexcept {
  if (rig.prediction == Prediction::hold || motion.tool != tool) return begin(rig, tool, t, tip, motion);
  const double h = age(t, motion.t);
  // What was known of its speed is worth nothing after so long.
  if (h > rig.longest_prediction) return begin(rig, tool, t, tip, motion);
  TipMotion next = motion;
  const bool velocity = rig.prediction == Prediction::constant_velocity;
  propagate(rig, h, velocity ? rig.acceleration_noise : rig.jerk_noise, next);
  if (velocity && !calm) {
    const double noise = surprised(rig, h, (tip - next.position).e(), next);
    if (noise > rig.acceleration_noise) {
      next = motion;
      propagate(rig, h, noise, next);
    }
  }
  const Vec3 innovation = (tip - next.position).e();
  if (innovation.norm() > kLeap + kFastest * h) return begin(rig, tool, t, tip, motion);
  correct(rig, innovation, next);
  next.t = t;
  motion = next;
}

Point<'W'> predict(const TrackerRig& rig, const TipMotion& motion, Time now) noexcept {
  const double h = carried_on(rig, age(now, motion.t));
  return Point<'W'>(
      Vec3(motion.position.e() + h * motion.velocity.e() + 0.5 * h * h * motion.acceleration.e()));
}

}  // namespace enc
