#include "core/guard/following.h"

#include <algorithm>

namespace enc {
namespace {

constexpr double kTolerance = 0.5e-3;  // m: play, bending, what the model leaves out
constexpr double kLags = 2.0;          // a servo may be so much slower than the rig says
constexpr double kPatience = 0.050;    // s

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length = along.squaredNorm();
  const double share = length > 0.0 ? std::clamp(along.dot(p - a) / length, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

}  // namespace

bool follows(const ServoModel& servo, const Point<'R'>& command, const Vec<'R'>& velocity,
             const Point<'R'>& measured, double dt, Following& state) noexcept {
  if (!state.expected.finite()) state.expected = measured;
  // Implicit in the speed, so that no frequency and no dt make it diverge.
  const double w = servo.frequency * dt;
  const Vec3 pull = (command - state.expected).e() * (servo.frequency * w);
  state.velocity = Vec<'R'>(Vec3((state.velocity.e() + pull) / (1.0 + 2.0 * servo.damping * w + w * w)));
  state.expected = state.expected + dt * state.velocity;
  state.fastest = std::max(velocity.norm(), state.fastest * std::max(0.0, 1.0 - dt / servo.lag()));
  // The model may lag by no more than the believed lag allows, or a rig that believes in a servo of 1e-6 Hz
  // would never find out a machine that stands.
  const double allowed = kTolerance + kLags * servo.lag() * state.fastest;
  const Vec3 behind = (state.expected - command).e();
  if (behind.norm() > allowed)
    state.expected = Point<'R'>(Vec3(command.e() + behind * (allowed / behind.norm())));
  const double away = distance_to_segment(measured.e(), state.expected.e(), command.e());
  const bool near = away <= allowed;
  state.off = near ? 0.0 : state.off + dt;
  return state.off < kPatience;
}

}  // namespace enc
