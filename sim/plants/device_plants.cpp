#include "sim/plants/device_plants.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/shape/deformation/dent.h"

namespace enc::sim {

DisplayPlant::DisplayPlant(const DisplayTruth& truth, const Scene& scene, std::uint64_t seed)
    : truth_(truth), scene_(scene) {
  if (truth.latency * truth.rate > 60.0)
    throw Error("at most 60 frames can be on their way at once", "truth.display.latency");
  Stream phase(seed, "display");
  state_.frame = {truth.rate, 0, from_seconds(phase.uniform() / truth.rate)};
}

DentSample DisplayPlant::draw() const {
  const View& view = state_.view;
  if (view.object < 0 || view.tool < 0 || !view.X_WT.valid()) return {};
  const Object& object = scene_.objects[static_cast<std::size_t>(view.object)];
  return dent_of(object.surface, view.object,
                 object.X_WO.inverse() * (view.X_WT * scene_.tools[static_cast<std::size_t>(view.tool)].tip));
}

void DisplayPlant::advance(Time t) {
  for (Time at = state_.frame.next(); state_.frame.due(t); at = state_.frame.next()) {
    state_.on_wire[state_.head] = {{draw(), at, Health::ok}, at + from_seconds(truth_.latency), true};
    state_.head = (state_.head + 1) % state_.on_wire.size();
  }
  for (Packet& packet : state_.on_wire) {
    if (!packet.waiting || packet.due > t) continue;
    packet.waiting = false;
    if (state_.arrived.health == Health::absent || packet.sample.t > state_.arrived.t) {
      state_.arrived = packet.sample;
      state_.news = true;
    }
  }
}

bool DisplayPlant::poll(Measurement<DentSample>& newest) noexcept {
  if (!state_.news) return false;
  newest = state_.arrived;
  state_.news = false;
  return true;
}

namespace {

// One channel set: noise, steps, range. `saturated`: the range was exceeded.
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
