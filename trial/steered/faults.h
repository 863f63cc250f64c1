// Faults of devices that somebody switches on and off during a run of the twin, to see what the core does.
// They change what the core reads, so a record holds them and a replay needs nothing else.
#pragma once

#include <cstdint>

#include "core/devices/signals.h"

namespace enc::trial {

enum Fault : std::uint8_t {
  kFrozenTracker = 1,   // repeats its last sample, whose time stands still
  kDroppedPackets = 2,  // three of four samples of the tracker are lost
  kLateClock = 4,       // the tracker's stamps are kLate too old
  kSaturated = 8        // the force sensor's range ends at kRange on each axis
};

class Faults {
 public:
  static constexpr double kLate = 0.05;  // s
  static constexpr double kRange = 3.0;  // N

  void set(std::uint8_t bits) { bits_ = bits; }
  // After reading, each tick.
  void apply(Inputs& in);

 private:
  std::uint8_t bits_ = 0;
  Stamped<TrackedTool> tool_;  // that the core was told last
  Time read_{};                // of the newest sample that was read
  std::int64_t samples_ = 0;   // since then
};

}  // namespace enc::trial
