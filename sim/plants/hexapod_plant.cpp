#include "sim/plants/hexapod_plant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace enc::sim {
namespace {

constexpr double kTurnSpeed = 0.6;  // rad/s (sources/hexapod 1)

Vec3 clipped(const Vec3& v, double longest) {
  const double size = v.norm();
  return size > longest ? Vec3(v * (longest / size)) : v;
}

Vec3 in_steps(const Vec3& p, double step) { return step > 0.0 ? Vec3((p / step).array().round() * step) : p; }

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
  Pending& pending = state_.pending;
  pending.line[static_cast<std::size_t>(pending.head % static_cast<std::int64_t>(kLongestDelay))] =
      state_.newest;
  const std::int64_t due = std::max<std::int64_t>(0, pending.head - truth_.delay_cycles);
  ++pending.head;
  const Pose<'R', 'H'>& command =
      pending.line[static_cast<std::size_t>(due % static_cast<std::int64_t>(kLongestDelay))];
  // Steps are counted from the machine's zero.
  const Vec3 zero = machine_.zero().p();
  const Pose<'R', 'H'> before = state_.wanted;
  state_.wanted = Pose<'R', 'H'>(Quat(command.q()), Vec3(zero + in_steps(command.p() - zero, truth_.step)));
  if (truth_.repeatability > 0.0 && (state_.wanted.xyz != before.xyz || state_.wanted.xyzw != before.xyzw))
    state_.play_due = Vec<'R'>(Vec3(truth_.repeatability * state_.noise.normal3()));
}

Pose<'R', 'H'> HexapodPlant::true_pose() const noexcept {
  return {Quat(state_.pose.q()), Vec3(state_.pose.p() + state_.play.e())};
}

// The servo's period in no less than 40 steps: a fast servo in one step would be quicker than it is.
void HexapodPlant::move(double timestep) noexcept {
  const double steps = std::max(1.0, std::ceil(40.0 * truth_.servo * timestep));
  const Vec3 before = state_.velocity.e();
  for (int i = 0; i < static_cast<int>(steps); ++i) {
    follow_position(timestep / steps);
    follow_rotation(timestep / steps);
  }
  state_.acceleration = Vec<'R'>(Vec3((state_.velocity.e() - before) / timestep));
  const double gain = 1.0 - std::exp(-2.0 * std::numbers::pi * truth_.servo * timestep);
  state_.play = state_.play + gain * (state_.play_due - state_.play);
}

// Second order with limits; semi-implicit, so that it stays stable at the physics step.
void HexapodPlant::follow_position(double timestep) noexcept {
  const double w = 2.0 * std::numbers::pi * truth_.servo;
  const Vec3 error = state_.wanted.p() - state_.pose.p();
  const Vec3 pull =
      clipped(w * w * error - 2.0 * truth_.damping * w * state_.velocity.e(), truth_.acceleration);
  const Vec3 velocity = clipped(state_.velocity.e() + timestep * pull, truth_.speed);
  state_.velocity = Vec<'R'>(velocity);
  const Vec3 p = state_.pose.p() + timestep * velocity;
  std::copy_n(p.data(), 3, state_.pose.xyz.begin());
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
