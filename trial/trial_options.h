// The options of a run, the data that it shows to observers, and its counts.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/control/step.h"
#include "core/devices/device.h"
#include "core/devices/mode.h"
#include "core/devices/rig.h"
#include "sim/truth/truth.h"
#include "trial/assemble/assemble.h"
#include "trial/family.h"
#include "trial/gate.h"
#include "trial/steered/steering.h"
#include "trial/trackers/frame_times.h"

namespace enc::trial {

// One tick for observing measures. The truth is only for them; the core does not see it.
struct Glance {
  const Scene& scene;
  const Tick& tick;
  const sim::Truth& truth;  // unset if no slot is simulated
  const Inputs& in;
  const Outputs& out;
  bool simulated = true;         // every slot is simulated, so the truth has all touches
  const State* state = nullptr;  // core's state after the tick, if available
  const Gate* gate = nullptr;    // gate between core and devices, if available
  // ns of the wall clock from the last step() to this one; 0: this is the first.
  std::uint32_t period_ns = 0;
  const Family& family = family_of(scene);  // the differences between families of machines
};

// A law that replaces step(), such as guide(), which moves an arm without a finger.
using Law = std::function<void(const Scene&, const Tick&, const Inputs&, State&, Outputs&)>;

struct TrialOptions {
  std::uint64_t seed = 1;
  // Unset: until the scene's user or probe is done; infinite: for ever.
  double seconds = kUnset;
  double pace = 0.0;             // experiment seconds for each wall second; 0: as fast as possible
  bool draw_all = false;         // also build parts that are only drawn
  DriverSource drivers{};        // empty: every slot is simulated, whatever the rig names
  std::string frames{};          // folder for the frames of the rig's camera; empty: not saved
  bool work = false;             // the twin computes its work for a LedgerMeasure; no other effect
  bool armed = false;            // sends commands to real devices; otherwise they are only computed
  bool real_time = false;        // gives a wall-clock run real-time priority (real_time.h)
  bool needs_real_time = false;  // refuses to arm a real machine without that priority
  bool lockstep = false;         // the peer is a fake whose time advances with this loop; needs `armed`
  bool calibrates = false;       // arms a real machine even if its rig's calibration is old or missing
  bool certify = false;          // computes certificates() even if no machine is armed
  std::function<bool()> stop{};  // called before each tick, and while the clock waits: true ends the run
  std::function<Hand()> hand{};  // called before each tick
  // Called before each tick with its index: the request of the person who steers the twin's hand; empty: no
  // news.
  std::function<std::optional<HandWord>(std::int64_t)> steer{};
  // Called once, after all computations beforehand, and before a device is connected or a file is made.
  std::function<void()> begins{};
  // Hooks, in the order of a tick; an empty hook is not called.
  std::function<void(Rig&)> fit_out{};  // once: replaces devices of the rig
  std::function<void(const Measurement<StereoFrame>&)>
      look{};                                  // while reading: each pair of a camera's images
  std::function<void(Inputs&)> disturb{};      // after reading
  Law law{};                                   // replaces step()
  std::function<void(const Glance&)> watch{};  // after the tick
  std::function<void(double)> progress{};      // share done, about ten times a second
};

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
