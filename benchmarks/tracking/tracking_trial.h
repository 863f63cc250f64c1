// The experiment of [VHMR 4.1], in the twin or over devices: scene `tracking` through the whole loop, and the
// error whenever a new packet has come (trial/travel/travel_measure.h).
#pragma once

#include <cstdint>
#include <string>

#include "benchmarks/kit/benchmark.h"
#include "benchmarks/tracking/tracking_theory.h"
#include "models/setup/scene_file.h"
#include "trial/travel/travel_measure.h"
#include "trial/trial.h"

namespace enc::bench::tracking {

using trial::ErrorSum;
using trial::Moving;
using trial::PacketError;

struct TravelErrors : trial::TravelSums {
  double simulated = 0.0;  // s
  std::string held{};      // a run did: when and why
  void add(const TravelErrors& other);
};

// Runs the travel of the set-up once; `base` as over_rig.h has it.
[[nodiscard]] TravelErrors run_travel(const models::Setup& setup, std::uint64_t seed, bool keep_packets,
                                      const trial::TrialOptions& base = {});

// Table 1 over the devices of the user's rig: tracking_rig.cpp.
void over_rig(Bench& bench);

// What rig, truth and scene of a set-up say to the theory.
[[nodiscard]] ChainSpec chain_of(const models::Setup& setup);
[[nodiscard]] MovesSpec moves_of(const models::Setup& setup);

}  // namespace enc::bench::tracking
