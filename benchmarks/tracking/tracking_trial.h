// The experiment of [VHMR 4.1], in the twin or over devices: scene `tracking` through the whole loop, and the
// error whenever a new packet has come: tracked tool tip (through the believed calibration) less where the
// machine says it is. All of it is what the core is told: no truth is asked.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/kit/benchmark.h"
#include "benchmarks/tracking/tracking_theory.h"
#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::bench::tracking {

// One packet: time, place along the axis, error along it, and how it counts.
enum class Moving : std::int8_t { back = -1, stopped = 0, forward = 1 };
struct PacketError {
  double t = 0.0, position = 0.0, error = 0.0;  // s, m, m
  Moving moving = Moving::stopped;
  std::int32_t axis = 0;  // of W
};

// Sums of what counts, in the words of sources/choices 10.
class ErrorSum {
 public:
  void add(double error);
  void add(const ErrorSum& other);
  [[nodiscard]] Errors errors() const;
  [[nodiscard]] std::int64_t size() const { return n_; }

 private:
  double sum_ = 0.0, size_ = 0.0, square_ = 0.0;
  std::int64_t n_ = 0;
};

struct TravelErrors {
  std::array<ErrorSum, 3> stopped, forward, back;  // of each axis of W, along it
  double largest = 0.0;                            // m, length of the whole error, any time
  double simulated = 0.0;                          // s
  std::vector<PacketError> packets;                // where asked for
  std::string held{};                              // a run did: when and why
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
