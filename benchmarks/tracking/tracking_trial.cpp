#include "benchmarks/tracking/tracking_trial.h"

#include <algorithm>

#include "benchmarks/kit/over_rig.h"

namespace enc::bench::tracking {

void TravelErrors::add(const TravelErrors& other) {
  TravelSums::add(other);
  simulated += other.simulated;
  if (held.empty()) held = other.held;
}

TravelErrors run_travel(const models::Setup& setup, std::uint64_t seed, bool keep_packets,
                        const trial::TrialOptions& base) {
  trial::TravelMeasure measure(keep_packets);
  trial::TrialOptions options = base;
  options.seed = seed;
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  trial::Trial trial(setup, options);
  while (trial.tick()) {
  }
  check_ended(trial);
  TravelErrors errors{measure.sums()};
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
          setup.twin.stepping(setup.scene).timestep};
}

}  // namespace enc::bench::tracking
