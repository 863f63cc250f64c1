#include "core/control/safety/following.h"

#include <algorithm>

namespace enc {
namespace {

constexpr double kTolerance = 0.5e-3;  // m: play, bending and other effects outside the model
constexpr double kPatience = 0.050;    // s

// True if p is within `distance` of the segment from a to b; usually it is near one of its ends.
bool near_segment(const Vec3& p, const Vec3& a, const Vec3& b, double distance) {
  const double most = distance * distance;
  if ((p - a).squaredNorm() <= most || (p - b).squaredNorm() <= most) return true;
  const Vec3 along = b - a;
  const double length = along.squaredNorm();
  const double share = length > 0.0 ? std::clamp(along.dot(p - a) / length, 0.0, 1.0) : 0.0;
  return (p - a - share * along).squaredNorm() <= most;
}

}  // namespace

bool follows(const ServoModel& servo, const Point<'R'>& command, const Vec<'R'>& velocity,
             const Point<'R'>& measured, FollowingState& state) noexcept {
  if (!state.expected.finite()) state.expected = measured;
  const Vec3 pull = servo.pull * (command - state.expected).e();
  state.velocity = Vec<'R'>(Vec3((state.velocity.e() + pull) * servo.left));
  state.expected = state.expected + servo.dt * state.velocity;
  // The model may lag by no more than the accepted lag allows. Otherwise a rig file with a servo of 1e-6 Hz
  // would never detect a machine that stands still.
  const double allowed = kTolerance + state.deviation.excused(velocity.norm(), servo.lag, servo.dt);
  const Vec3 behind = (state.expected - command).e();
  if (behind.squaredNorm() > allowed * allowed)
    state.expected = Point<'R'>(Vec3(command.e() + behind * (allowed / behind.norm())));
  const bool near = near_segment(measured.e(), state.expected.e(), command.e(), allowed);
  return !state.deviation.too_long(!near, kPatience, servo.dt);
}

}  // namespace enc
