// The counts of a run.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/devices/clock.h"
#include "core/devices/mode.h"
#include "trial/assemble/assemble.h"
#include "trial/gate.h"
#include "trial/trackers/frame_times.h"

namespace enc::trial {

struct TrialResult {
  std::int64_t ticks = 0;
  double simulated = 0.0, wall = 0.0;  // s
  std::array<double, kModes> mode_time{};
  std::int32_t contacts = 0;
  std::int64_t mode_changes = 0;
  static constexpr std::int64_t kMostHolds = 16;
  std::vector<std::pair<Time, std::uint32_t>> holds;  // start and reasons of the first holds
  std::int64_t times_held = 0;                        // number of all holds
  std::pair<Time, std::uint32_t> last_hold{};         // last tick of the last hold, and its reasons
  Mode last_mode = Mode::away;
  std::uint32_t last_why = 0;
  std::uint64_t hash = 0;
  // A run of hours keeps only its first ticks, some 17 minutes.
  static constexpr std::int64_t kMostTimed = 1 << 20;
  std::vector<std::uint32_t> step_ns;    // each step(), in wall time
  std::vector<std::uint32_t> period_ns;  // paced runs: from one step() to the next, in wall time
  FrameTimes vision;                     // scene with a camera only
  std::int64_t diverged_at = -1;
  std::string divergence;
  bool stopped = false;              // the record could not be written
  bool interrupted = false;          // ended by options.stop
  std::int64_t withheld = 0;         // commands to real devices that were not armed
  std::int64_t missed = 0;           // cycles lost against the wall clock
  Lateness lateness;                 // against the wall clock
  std::vector<DeviceWords> devices;  // real devices' own descriptions
  std::string real_time;             // real-time priority of the loop; empty: not requested
  bool keeps_wall_time = false;      // the run may not be made to wait
  std::vector<LostLink> links;       // the first 16 lost links
  std::vector<std::string> log;      // the drivers' messages
};

}  // namespace enc::trial
