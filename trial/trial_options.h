// The options of a run, and the data that it shows to observers.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/control/step.h"
#include "core/devices/rig.h"
#include "core/devices/stereo_camera.h"
#include "sim/truth/truth.h"
#include "trial/assemble/assemble.h"
#include "trial/family.h"
#include "trial/gate.h"
#include "trial/steered/hand_word.h"

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
  const Family& family = family_of(scene);  // what its machine does in its own way
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
  std::function<void(Rig&)> fit_out{};                      // once: replaces devices of the rig
  std::function<void(const Stamped<StereoFrame>&)> look{};  // while reading: each pair of a camera's images
  std::function<void(Inputs&)> disturb{};                   // after reading
  Law law{};                                                // replaces step()
  std::function<void(const Glance&)> watch{};               // after the tick
  std::function<void(double)> progress{};                   // share done, about ten times a second
};

}  // namespace enc::trial
