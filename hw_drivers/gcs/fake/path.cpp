#include "hw_drivers/gcs/fake/path.h"

#include <algorithm>
#include <cmath>

namespace enc::gcs {
namespace {

double norm(const Coordinates& way) { return distance(Coordinates{}, way); }

}  // namespace

void Profile::reset(const Coordinates& at) noexcept {
  at_ = to_ = at;
  velocity_ = {};
  hardness_ = 0.0;
  moving_ = false;
}

void Profile::go(const Coordinates& to) noexcept {
  to_ = to;
  hardness_ = 0.0;
  moving_ = moving_ || to_ != at_;
}

void Profile::halt(double hardness) noexcept {
  if (moving_) hardness_ = hardness;
}

void Profile::step(double dt, const ProfileLimits& limits) noexcept {
  if (!moving_) return;
  const double most = limits.acceleration * std::max(hardness_, 1.0) * dt;  // change of speed
  Coordinates way{}, change{};
  for (std::size_t i = 0; i < kAxes; ++i) way[i] = hardness_ > 0.0 ? 0.0 : to_[i] - at_[i];
  const double far = norm(way);
  // Highest speed from which the platform can still brake in time, in steps of dt.
  const double braking = std::sqrt(0.25 * most * most + 2.0 * limits.acceleration * far) - 0.5 * most;
  const double speed = std::min({limits.velocity, braking, far / dt});
  for (std::size_t i = 0; i < kAxes; ++i) change[i] = (far > 0.0 ? way[i] / far * speed : 0.0) - velocity_[i];
  const double share = std::min(1.0, most / std::max(norm(change), 1e-300));
  for (std::size_t i = 0; i < kAxes; ++i) {
    velocity_[i] += share * change[i];
    at_[i] += velocity_[i] * dt;
    way[i] = to_[i] - at_[i];
  }
  constexpr double kThere = 1e-9;  // m
  const bool slow = norm(velocity_) <= most;
  if (hardness_ > 0.0 ? share == 1.0 : slow && norm(way) <= kThere) reset(hardness_ > 0.0 ? at_ : to_);
}

}  // namespace enc::gcs
