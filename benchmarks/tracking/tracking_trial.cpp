#include "benchmarks/tracking/tracking_trial.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmarks/kit/over_rig.h"

namespace enc::bench::tracking {
namespace {

constexpr double kSettled = 0.3;  // s at rest before a stop counts: longer than any packet is on its way

class TravelMeasure {
 public:
  TravelMeasure(trial::Trial& trial, bool keep) : trial_(trial), keep_(keep) {}

  void see() {
    const Scene& scene = trial_.scene();
    const Inputs& in = trial_.inputs();
    const Travelling& now = recall<Travelling>(trial_.state());
    if (in.tip.health == Health::absent || !scene.travel()->on_leg(now.leg)) return;
    const TravelLeg& leg = scene.travel()->legs[static_cast<std::size_t>(now.leg)];
    const Vec3 velocity = (scene.X_WR * in.tip.value.velocity).e();
    const double t = seconds(in.tip.t.time_since_epoch());
    if (velocity.norm() > kMoving) moved_ = t;
    if (in.tool.health != Health::ok || in.tool.t == stamp_) return;
    stamp_ = in.tool.t;
    // Over a wire a position is some milliseconds old.
    const Vec<'W'> since(Vec3(age(trial_.now().t, in.tip.t) * velocity));
    const Point<'W'> tip = scene.X_WR * in.tip.value.X_RH.origin() + since;
    const Tool& tool = scene.tools[static_cast<std::size_t>(in.tool.value.tool)];
    const Vec3 error = (scene.X_WC * in.tool.value.X_CT * tool.tip.centre - tip).e();
    errors_.largest = std::max(errors_.largest, error.norm());
    // On the way to a start nothing counts but the stop at its end.
    const bool at_rest = now.phase == TravelPhase::dwell && t - moved_ > kSettled;
    const std::int32_t axis = leg.axis >= 0 ? leg.axis : next_axis(*scene.travel(), now.leg);
    if (axis < 0 || (leg.axis < 0 && !at_rest)) return;
    count({t, tip.xyz[static_cast<std::size_t>(axis)], error[axis], Moving::stopped, axis}, velocity[axis],
          at_rest);
  }
  TravelErrors take() { return std::move(errors_); }

 private:
  static std::int32_t next_axis(const Travel& travel, std::int32_t leg) {
    return travel.on_leg(leg + 1) ? travel.legs[static_cast<std::size_t>(leg) + 1].axis : -1;
  }
  void count(PacketError packet, double speed, bool at_rest) {
    const auto axis = static_cast<std::size_t>(packet.axis);
    if (std::abs(speed) > kMoving) {
      packet.moving = speed > 0.0 ? Moving::forward : Moving::back;
      (speed > 0.0 ? errors_.forward : errors_.back)[axis].add(packet.error);
    } else if (at_rest) {
      errors_.stopped[axis].add(packet.error);
    }
    if (keep_) errors_.packets.push_back(packet);
  }

  trial::Trial& trial_;
  bool keep_;
  TravelErrors errors_;
  Time stamp_{};
  double moved_ = 0.0;
};

}  // namespace

void ErrorSum::add(double error) {
  sum_ += error;
  size_ += std::abs(error);
  square_ += error * error;
  ++n_;
}

void ErrorSum::add(const ErrorSum& other) {
  sum_ += other.sum_;
  size_ += other.size_;
  square_ += other.square_;
  n_ += other.n_;
}

Errors ErrorSum::errors() const {
  if (n_ == 0) return {kUnset, kUnset, kUnset};
  const auto n = static_cast<double>(n_);
  return {std::sqrt(square_ / n), size_ / n, std::abs(sum_) / n};
}

void TravelErrors::add(const TravelErrors& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    stopped[axis].add(other.stopped[axis]);
    forward[axis].add(other.forward[axis]);
    back[axis].add(other.back[axis]);
  }
  largest = std::max(largest, other.largest);
  simulated += other.simulated;
  if (held.empty()) held = other.held;
  packets.insert(packets.end(), other.packets.begin(), other.packets.end());
}

TravelErrors run_travel(const models::Setup& setup, std::uint64_t seed, bool keep_packets,
                        const trial::TrialOptions& base) {
  trial::TrialOptions options = base;
  options.seed = seed;
  trial::Trial trial(setup, options);
  TravelMeasure measure(trial, keep_packets);
  while (trial.tick()) measure.see();
  check_ended(trial);
  TravelErrors errors = measure.take();
  errors.held = held_in(trial);
  errors.simulated = static_cast<double>(trial.result().ticks) * trial.scene().dt;
  return errors;
}

ChainSpec chain_of(const models::Setup& setup) {
  const sim::TrackerTruth& t = setup.twin.tracker;
  return {t.rate, t.server_rate, t.latency + t.process, t.udp_delay, 1.0 / setup.rig.loop.rate};
}

MovesSpec moves_of(const models::Setup& setup) {
  const sim::HexapodTruth& machine = setup.twin.hexapod;
  return {setup.scene.travel->stops,
          setup.scene.travel->speed,
          std::min(machine.acceleration, setup.rig.manipulator.acceleration),
          machine.servo,
          machine.damping,
          machine.speed,
          setup.twin.stepping(setup.scene.arm.has_value()).timestep};
}

}  // namespace enc::bench::tracking
