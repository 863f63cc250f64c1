// What a run counts by itself.
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
  std::vector<std::pair<Time, std::uint32_t>> holds;  // when each began, and why; the first of them
  std::int64_t times_held = 0;                        // all of them
  std::pair<Time, std::uint32_t> last_hold{};         // its last tick, and why; where there was any
  Mode last_mode = Mode::away;
  std::uint32_t last_why = 0;
  std::uint64_t hash = 0;
  // Of hours nobody keeps all: these are of the first ticks, some 17 minutes.
  static constexpr std::int64_t kMostTimed = 1 << 20;
  std::vector<std::uint32_t> step_ns;    // of each step(), as the wall clock saw it
  std::vector<std::uint32_t> period_ns;  // where a pace is kept: from one step() to the next, likewise
  FrameTimes vision;                     // where the scene has a camera
  std::int64_t diverged_at = -1;
  std::string divergence;
  bool stopped = false;              // record could not be written
  bool interrupted = false;          // options.stop said so
  std::int64_t withheld = 0;         // commands to real devices that were not armed
  std::int64_t missed = 0;           // cycles that were lost to the wall clock
  Lateness lateness;                 // against the wall clock
  std::vector<DeviceWords> devices;  // real ones, as they describe themselves
  std::string real_time;             // how the loop comes before other work; empty: not asked for
  bool keeps_wall_time = false;      // nobody may make it wait
  std::vector<LostLink> links;       // the first 16 that were lost
  std::vector<std::string> log;      // what drivers said
};

}  // namespace enc::trial
