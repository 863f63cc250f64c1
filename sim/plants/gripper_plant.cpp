#include "sim/plants/gripper_plant.h"

#include <algorithm>
#include <cmath>

namespace enc::sim {

GripperPlant::GripperPlant(const GripperTruth& truth, std::uint64_t seed) : truth_(truth) {
  state_.noise = Stream(seed, "gripper");
  state_.sample.value.opening = 2.0 * truth.stroke;
}

void GripperPlant::command(const Grip& grip) noexcept {
  Health& health = state_.sample.health;
  if (grip.closed && !std::isfinite(grip.force)) {
    health = Health::fault;
    return;
  }
  state_.wanted = grip;
  health = Health::ok;
  if (!grip.closed) return;
  state_.wanted.force = std::clamp(grip.force, truth_.force_min, truth_.force_max);
  if (state_.wanted.force != grip.force) health = Health::out_of_range;
}

double GripperPlant::stop() const noexcept { return std::max(0.0, truth_.width + state_.play); }

void GripperPlant::begin(bool closing) noexcept {
  GripSample& s = state_.sample.value;
  s.phase = closing ? GripPhase::closing : GripPhase::opening;
  s.force = 0.0;
  s.holding = false;
  if (closing) state_.play = truth_.repeatability * state_.noise.normal();
}

void GripperPlant::advance(Time t, double dt) noexcept {
  GripSample& s = state_.sample.value;
  state_.sample.t = t;
  if (state_.sample.health == Health::absent) state_.sample.health = Health::ok;
  const bool closes = s.phase == GripPhase::closing || s.phase == GripPhase::closed;
  if (state_.wanted.closed != closes) begin(state_.wanted.closed);
  const double way = 2.0 * truth_.stroke / truth_.closing_time * dt;  // of both jaws
  if (s.phase == GripPhase::closing) {
    s.opening = std::max(stop(), s.opening - way);
    if (s.opening == stop()) s.phase = GripPhase::closed;
  } else if (s.phase == GripPhase::opening) {
    s.opening = std::min(2.0 * truth_.stroke, s.opening + way);
    if (s.opening == 2.0 * truth_.stroke) s.phase = GripPhase::open;
  }
  if (s.phase != GripPhase::closed) return;
  s.holding = truth_.width > 0.0;
  s.force = s.holding ? state_.wanted.force : 0.0;
}

}  // namespace enc::sim
