#include "sim/plants/hexapod_plant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/machine/servo.h"

namespace enc::sim {
namespace {

constexpr double kTurnSpeed = 0.6;  // rad/s (sources/hexapod 1)

}  // namespace

HexapodPlant::HexapodPlant(const HexapodTruth& truth, std::uint64_t seed)
    : truth_(truth), machine_(truth.geometry) {
  if (truth.delay_cycles < 0 || truth.delay_cycles >= static_cast<std::int64_t>(kLongestDelay))
    throw Error("the machine's delay is 0 to 63 cycles", "truth.hexapod.delay_cycles");
  state_.pose = state_.wanted = state_.newest = machine_.zero();
  state_.noise = Stream(seed, "hexapod");
  state_.pending.line.fill(state_.newest);
}

void HexapodPlant::command(const Pose<'R', 'H'>& X_RH) noexcept {
  if (!X_RH.valid()) {
    state_.health = Health::fault;
    return;
  }
  state_.health = Health::ok;
  if (machine_.limit(X_RH) == ReachLimit::none) {
    state_.newest = X_RH;
    return;
  }
  state_.health = Health::out_of_range;
  double lo = 0.0;
  double hi = 1.0;
  const Pose<'R', 'H'> from = state_.newest;
  for (int i = 0; i < 30; ++i) {
    const double mid = 0.5 * (lo + hi);
    const Pose<'R', 'H'> between(from.q().slerp(mid, X_RH.q()), Vec3(from.p() + mid * (X_RH.p() - from.p())));
    if (machine_.limit(between) == ReachLimit::none) {
      lo = mid;
      state_.newest = between;
    } else {
      hi = mid;
    }
  }
}

void HexapodPlant::begin_cycle() noexcept {
  if (state_.led) return;
  PendingCommands& pending = state_.pending;
  pending.line[static_cast<std::size_t>(pending.head % static_cast<std::int64_t>(kLongestDelay))] =
      state_.newest;
  const std::int64_t due = std::max<std::int64_t>(0, pending.head - truth_.delay_cycles);
  ++pending.head;
  const Pose<'R', 'H'>& command =
      pending.line[static_cast<std::size_t>(due % static_cast<std::int64_t>(kLongestDelay))];
  // Steps count from the machine's zero.
  const Vec3 zero = machine_.zero().p();
  const Pose<'R', 'H'> before = state_.wanted;
  state_.wanted = Pose<'R', 'H'>(Quat(command.q()), Vec3(zero + in_steps(command.p() - zero, truth_.step)));
  if (truth_.repeatability > 0.0 && (state_.wanted.xyz != before.xyz || state_.wanted.xyzw != before.xyzw))
    state_.play_due = Vec<'R'>(Vec3(truth_.repeatability * state_.noise.normal3()));
}

Pose<'R', 'H'> HexapodPlant::true_pose() const noexcept {
  return {Quat(state_.pose.q()), Vec3(state_.pose.p() + state_.play.e())};
}

void HexapodPlant::lead(const TipSample& seen) noexcept {
  if (!seen.X_RH.valid()) return;
  state_.led = true;
  state_.pose = state_.wanted = state_.newest = seen.X_RH;
  state_.velocity = seen.velocity.finite() ? seen.velocity : Vec<'R'>::zero();
  state_.acceleration = seen.acceleration.finite() ? seen.acceleration : Vec<'R'>::zero();
  state_.turning = state_.play = Vec<'R'>::zero();
}

void HexapodPlant::move(double timestep) noexcept {
  if (state_.led) return;
  const ServoLaw law = servo_of(truth_);
  ServoMotion motion{state_.pose.p(), state_.velocity.e()};
  follow(law, state_.wanted.p(), timestep, motion);
  std::copy_n(motion.p.data(), 3, state_.pose.xyz.begin());
  state_.velocity = Vec<'R'>(motion.velocity);
  state_.acceleration = Vec<'R'>(motion.acceleration);
  const int steps = servo_steps(law, timestep);
  for (int i = 0; i < steps; ++i) follow_rotation(timestep / steps);
  const double gain = 1.0 - std::exp(-2.0 * std::numbers::pi * truth_.servo * timestep);
  state_.play = state_.play + gain * (state_.play_due - state_.play);
}

void HexapodPlant::follow_rotation(double timestep) noexcept {
  const Eigen::AngleAxisd error(state_.wanted.q() * state_.pose.q().conjugate());
  if (error.angle() == 0.0 && state_.turning.norm() == 0.0) return;
  const double w = 2.0 * std::numbers::pi * truth_.servo;
  const Vec3 pull = w * w * error.angle() * error.axis() - 2.0 * truth_.damping * w * state_.turning.e();
  state_.turning = Vec<'R'>(clipped(state_.turning.e() + timestep * pull, kTurnSpeed));
  const double angle = state_.turning.norm() * timestep;
  if (angle == 0.0) return;
  const Quat turned =
      (Quat(Eigen::AngleAxisd(angle, state_.turning.e().normalized())) * state_.pose.q()).normalized();
  std::copy_n(turned.coeffs().data(), 4, state_.pose.xyzw.begin());
}

}  // namespace enc::sim
