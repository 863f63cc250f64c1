// Device faults that a user switches on and off during a run of the twin, to watch the core's reaction. They
// change the core's inputs, so a record contains them, and a replay needs no other data.
#pragma once

#include <cstdint>

#include "core/devices/signals.h"

namespace enc::trial {

enum Fault : std::uint8_t {
  kFrozenTracker = 1,   // repeats its last sample with its old stamp
  kDroppedPackets = 2,  // three of four samples of the tracker are lost
  kLateClock = 4,       // the tracker's stamps are kLate too old
  kSaturated = 8        // the force sensor's range ends at kRange on each axis
};

class Faults {
 public:
  static constexpr double kLate = 0.05;  // s
  static constexpr double kRange = 3.0;  // N

  void set(std::uint8_t bits) { bits_ = bits; }
  // Call this after reading, in each tick.
  void apply(Inputs& in);

 private:
  std::uint8_t bits_ = 0;
  Stamped<TrackedTool> tool_;  // last sample passed to the core
  Time read_{};                // stamp of the newest sample read
  std::int64_t samples_ = 0;   // since then
};

}  // namespace enc::trial
