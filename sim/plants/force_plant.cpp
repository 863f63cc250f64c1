#include "sim/plants/force_plant.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/rotation.h"

namespace enc::sim {
namespace {

// One channel set: noise, steps, range. Says whether the range was met.
Vec3 digitised(const Vec3& value, double quantum, double range, bool& saturated) {
  const Vec3 stepped = quantum > 0.0 ? Vec3((value / quantum).array().round() * quantum) : value;
  const Vec3 kept = stepped.cwiseMax(-range).cwiseMin(range);
  saturated = saturated || kept != stepped;
  return kept;
}

}  // namespace

ForcePlant::ForcePlant(const ForceTruth& truth, std::uint64_t seed)
    : truth_(truth), turned_(rotation_xyz(truth.turned).conjugate()) {
  state_.noise = Stream(seed, "force");
  state_.zero = Vec<'F'>(Vec3(truth.zero * state_.noise.normal3()));
}

void ForcePlant::begin_push() noexcept {
  const Vec<'F'> next(Vec3(truth_.push_drift * state_.noise.normal3()));
  state_.shift_left = truth_.drift_ahead;
  if (state_.shift_left > 0.0)
    state_.shifting = (1.0 / state_.shift_left) * (next - state_.shifted);
  else
    state_.shifted = next;
}

void ForcePlant::measure(Time t, double dt, const Wrench& raw, const Vec<'F'>& inertia) {
  state_.zero = state_.zero + Vec<'F'>(Vec3(truth_.drift * std::sqrt(dt) * state_.noise.normal3()));
  if (state_.shift_left > 0.0) {
    state_.shifted = state_.shifted + std::min(dt, state_.shift_left) * state_.shifting;
    state_.shift_left -= dt;
  }
  bool saturated = false;
  const auto read = [&]() -> std::pair<Vec3, Vec3> {
    const Vec3 force =
        turned_ * (raw.force - inertia).e() + zero().e() + truth_.noise * state_.noise.normal3();
    const Vec3 torque = turned_ * raw.torque.e() + truth_.torque_noise * state_.noise.normal3();
    return {digitised(force, truth_.quantum, truth_.range, saturated),
            digitised(torque, truth_.torque_quantum, truth_.torque_range, saturated)};
  };
  auto [force, torque] = read();
  for (std::int64_t i = 1; i < truth_.oversampling; ++i) {
    const auto [more_force, more_torque] = read();
    force += more_force;
    torque += more_torque;
  }
  const auto n = static_cast<double>(truth_.oversampling);
  state_.sample.value.force = Vec<'F'>(Vec3(force / n));
  state_.sample.value.torque = Vec<'F'>(Vec3(torque / n));
  state_.sample.t = t;
  state_.sample.health = saturated ? Health::saturated : Health::ok;
}

}  // namespace enc::sim
