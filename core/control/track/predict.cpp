#include "core/control/track/predict.h"

#include <algorithm>
#include <cmath>

namespace enc {
namespace {

// A hand does not jump by more than this between two poses: another tool was recognised, or the hand came
// back.
constexpr double kFastest = 5.0;  // m/s
constexpr double kLeap = 5e-3;    // m
// Prior uncertainty of a tool that has just come into view.
constexpr double kSpeed = 0.3;         // m/s rms
constexpr double kAcceleration = 3.0;  // m/s^2 rms
// After the longest prediction, the tip is assumed to come to rest within this time (sources/tracking 5: 200
// ms in all).
constexpr double kSlowDown = 0.1;  // s

double square(double x) { return x * x; }

void begin(const TrackerRig& rig, std::int32_t tool, Time t, const Point<'W'>& tip, const TipNoise& noise,
           TipMotion& motion) {
  motion = {tool, t, tip, Vec<'W'>::zero(), Vec<'W'>::zero(), {}, {}};
  motion.along.xx = square(noise.along);
  motion.across.xx = square(noise.across);
  for (AxisDoubt* const d : {&motion.along, &motion.across}) {
    d->vv = square(kSpeed);
    d->aa = rig.prediction == Prediction::constant_acceleration ? square(kAcceleration) : 0.0;
  }
}

// Time for which speed and acceleration may be extrapolated from a pose of age `old`, s.
double carried_on(const TrackerRig& rig, double old) {
  const double late = std::clamp(old - rig.longest_prediction, 0.0, kSlowDown);
  return std::clamp(old, 0.0, rig.longest_prediction) + late - 0.5 * late * late / kSlowDown;
}

// The covariance h s later. White noise drives the acceleration (constant velocity) or the jerk (constant
// acceleration) [Bar-Shalom, Estimation with Applications, 6.2]; `noise` is its density.
void propagate(const TrackerRig& rig, double h, double noise, AxisDoubt& d) {
  // P <- F P F', F = [1 h h^2/2; 0 1 h; 0 0 1], row by row.
  const double k = 0.5 * h * h;
  const double xx = d.xx + h * d.xv + k * d.xa;
  const double xv = d.xv + h * d.vv + k * d.va;
  const double xa = d.xa + h * d.va + k * d.aa;
  const double vv = d.vv + h * d.va;
  const double va = d.va + h * d.aa;
  d.xx = xx + h * xv + k * xa;
  d.xv = xv + h * xa;
  d.xa = xa;
  d.vv = vv + h * va;
  d.va = va;
  const double q = square(noise);
  if (rig.prediction == Prediction::constant_velocity) {
    d.xx += q * h * h * h / 3.0;
    d.xv += q * h * h / 2.0;
    d.vv += q * h;
  } else {
    d.xx += q * h * h * h * h * h / 20.0;
    d.xv += q * h * h * h * h / 8.0;
    d.xa += q * h * h * h / 6.0;
    d.vv += q * h * h * h / 3.0;
    d.va += q * h * h / 2.0;
    d.aa += q * h;
  }
}

// The state h s later.
void propagate(const TrackerRig& rig, double h, double noise, TipMotion& m) {
  m.position.e() += h * m.velocity.e() + 0.5 * h * h * m.acceleration.e();
  m.velocity.e() += h * m.acceleration.e();
  propagate(rig, h, noise, m.along);
  propagate(rig, h, noise, m.across);
}

// Times sigma (derived: with three axes together, noise alone exceeds four sigma once in 900 poses and three
// sigma once in 34, which would be in every tenth approach).
constexpr double kSigmas = 4.0;

// A hand keeps its speed for long and then changes it suddenly. A pose farther off than kSigmas is explained
// by as much acceleration as it takes, not by noise [Bar-Shalom 11.2].
double surprised(const TrackerRig& rig, double h, const Vec3& innovation, const TipNoise& noise,
                 const TipMotion& m) {
  const double along = m.along.xx + square(noise.along);
  const double across = m.across.xx + square(noise.across);  // of each side
  const double deep = square(noise.view.e().dot(innovation)), all = innovation.squaredNorm();
  const double far = across > 0.0 ? (all - deep) / across + (along > 0.0 ? deep / along : 0.0) : HUGE_VAL;
  if (rig.surprise_noise <= rig.acceleration_noise || far <= square(kSigmas)) return 0.0;
  // Adding x = q h^3 / 3 on each axis makes the innovation usual: deep / (along + x) + (all - deep) / (across
  // + x) = 3.
  const double half = 0.5 * (along + across - all / 3.0);
  const double rest = along * across - (deep * across + (all - deep) * along) / 3.0;
  const double x = std::sqrt(std::max(0.0, half * half - rest)) - half;
  return std::min(rig.surprise_noise,
                  std::sqrt(square(rig.acceleration_noise) + 3.0 * std::max(0.0, x) / (h * h * h)));
}

struct Gains {
  double x = 1.0, v = 0.0, a = 0.0;
};
Gains correct(double noise, AxisDoubt& d) {
  Gains k;
  const double s = d.xx + square(noise);
  if (s > 0.0) k = {d.xx / s, d.xv / s, d.xa / s};  // neither noise nor uncertainty: the pose is exact
  d.vv -= k.v * d.xv;
  d.va -= k.v * d.xa;
  d.aa -= k.a * d.xa;
  d.xv *= 1.0 - k.x;
  d.xa *= 1.0 - k.x;
  d.xx *= 1.0 - k.x;
  return k;
}
void correct(const Vec3& innovation, const TipNoise& noise, TipMotion& m) {
  const Gains along = correct(noise.along, m.along), across = correct(noise.across, m.across);
  const Vec3 deep = noise.view.e().dot(innovation) * noise.view.e();
  m.position.e() += across.x * innovation + (along.x - across.x) * deep;
  m.velocity.e() += across.v * innovation + (along.v - across.v) * deep;
  m.acceleration.e() += across.a * innovation + (along.a - across.a) * deep;
}

}  // namespace

TipNoise noise_of(const TrackerRig& rig, const TrackedTool& pose, const Pose<'W', 'C'>& X_WC) noexcept {
  const Vec<'C'> view(pose.X_CT.p());
  const bool told = std::isfinite(pose.along) && std::isfinite(pose.across) && view.norm() > 0.0;
  if (!told) return {rig.measurement_noise, rig.measurement_noise};
  return {pose.along, pose.across, X_WC * ((1.0 / view.norm()) * view)};
}

void observe(const TrackerRig& rig, std::int32_t tool, Time t, const Point<'W'>& tip, const TipNoise& noise,
             TipMotion& motion, bool calm) noexcept {
  if (rig.prediction == Prediction::hold || motion.tool != tool)
    return begin(rig, tool, t, tip, noise, motion);
  const double h = age(t, motion.t);
  // After so long, the estimated speed is worthless.
  if (h > rig.longest_prediction) return begin(rig, tool, t, tip, noise, motion);
  TipMotion next = motion;
  const bool velocity = rig.prediction == Prediction::constant_velocity;
  propagate(rig, h, velocity ? rig.acceleration_noise : rig.jerk_noise, next);
  if (velocity && !calm) {
    const double density = surprised(rig, h, (tip - next.position).e(), noise, next);
    if (density > rig.acceleration_noise) {
      next = motion;
      propagate(rig, h, density, next);
    }
  }
  const Vec3 innovation = (tip - next.position).e();
  if (innovation.norm() > kLeap + kFastest * h) return begin(rig, tool, t, tip, noise, motion);
  correct(innovation, noise, next);
  next.t = t;
  motion = next;
}

void correct_now(const TrackerRig& rig, Time now, const Vec<'W'>& off, TipMotion& motion) noexcept {
  if (rig.prediction == Prediction::hold || motion.tool < 0) return;
  // Only depth is corrected, because pictures measure it badly.
  const AxisDoubt& d = motion.along;
  const double h = carried_on(rig, age(now, motion.t)), k = 0.5 * h * h;
  const double x = d.xx + h * d.xv + k * d.xa, v = d.xv + h * d.vv + k * d.va, a = d.xa + h * d.va + k * d.aa;
  const double all = x + h * v + k * a;
  if (!(all > 0.0) || !off.finite()) return;
  motion.position = motion.position + (x / all) * off;
  motion.velocity = motion.velocity + (v / all) * off;
  motion.acceleration = motion.acceleration + (a / all) * off;
}

Point<'W'> predict(const TrackerRig& rig, const TipMotion& motion, Time now) noexcept {
  const double h = carried_on(rig, age(now, motion.t));
  return Point<'W'>(
      Vec3(motion.position.e() + h * motion.velocity.e() + 0.5 * h * h * motion.acceleration.e()));
}

}  // namespace enc
