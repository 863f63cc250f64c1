// The steering of the twin's hand during a run: requested places, tools and device faults. A record keeps the
// log of these requests, and a later run plays it back (docs/reference/record.md, "hand").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/devices/signals.h"

namespace enc::trial {

// Device faults that a user switches on and off during a run of the twin, to watch the core's reaction. They
// change the core's inputs, so a record contains them, and a replay needs no other data.
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
  Measurement<TrackedTool> tool_;  // last sample passed to the core
  Time read_{};                    // stamp of the newest sample read
  std::int64_t samples_ = 0;       // samples since the first
};

// Request at a tick.
struct HandWord {
  std::optional<Point<'W'>> place{};  // requested place of the tool's tip; unset: no change
  // The hand lays its tool down and takes the other one.
  bool changes_tool = false;
  std::uint8_t faults = 0;  // bits of Fault, from here on
};

// The requests of a steered run, with the ticks from which they hold.
class SteeringLog {
 public:
  void add(std::int64_t tick, const HandWord& word) { steps_.push_back({tick, word}); }
  [[nodiscard]] bool empty() const { return steps_.empty(); }
  // All new requests since the last call up to `tick`, or unset, as TrialOptions::steer expects. Ticks must
  // ascend.
  [[nodiscard]] std::optional<HandWord> at(std::int64_t tick);

  // CSV with one line for each step: tick, whether there is a place, the place in W, m, whether the tool is
  // changed, bits of the faults. Numbers read back to the bit.
  [[nodiscard]] std::string text() const;
  // Reads the text of a record, which may be corrupt. Throws Error (kind input) with the line.
  static SteeringLog read(const std::string& text, const std::string& record);

 private:
  struct Step {
    std::int64_t tick = 0;
    HandWord word;
  };
  std::vector<Step> steps_;
  std::size_t next_ = 0;
};

// The steering in a record, and the duration of that run.
struct SteeredRun {
  SteeringLog log;
  double duration = 0.0, period = 0.0;  // s: length of the run, and of its ticks
  std::string seed;
};
// Throws Error (kind input) for a file that is not a record, or a record without steering.
[[nodiscard]] SteeredRun steered_run(const std::string& record);

}  // namespace enc::trial
