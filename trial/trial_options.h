// What a run is told, and what it shows to those that look on.
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
#include "trial/gate.h"
#include "trial/steered/hand_word.h"

namespace enc::trial {

// What a tick was, for measures that look on. Truth is for them alone; the core does not see it.
struct Glance {
  const Scene& scene;
  const Tick& tick;
  const sim::Truth& truth;  // nothing in it is set where no slot is simulated
  const Inputs& in;
  const Outputs& out;
  bool simulated = true;         // every slot: the truth knows what is touched
  const State* state = nullptr;  // of the core, after the tick, where it is at hand
  const Gate* gate = nullptr;    // between core and devices, likewise
  // ns of the wall clock, from the step() before to this one; 0: this is the first
  std::uint32_t period_ns = 0;
};

// Another law in place of step(), such as guide(), which moves an arm without a finger.
using Law = std::function<void(const Scene&, const Tick&, const Inputs&, State&, Outputs&)>;

struct TrialOptions {
  std::uint64_t seed = 1;
  double seconds = kUnset;  // unset: until the user or the probe of the scene is done; infinite: for ever
  double pace = 0.0;        // experiment seconds for each wall second; 0: as fast as it goes
  bool draw_all = false;    // build what is only looked at, too
  DriverSource drivers{};   // none: every slot is simulated, whatever the rig names
  std::string frames{};     // folder in which the frames of its camera are kept; empty: nowhere
  bool work = false;        // the twin counts its work, as a LedgerMeasure asks; nothing else differs
  bool armed = false;       // commands are sent to real devices; else they are only computed
  bool real_time = false;   // a run that keeps the wall clock comes before other work (real_time.h)
  bool needs_real_time = false;  // a machine that is no fake is not armed where that is refused
  bool lockstep = false;         // what answers is a fake whose time goes on with this loop's; needs `armed`
  bool calibrates = false;       // a real machine is armed, though nobody has measured its rig of late
  bool certify = false;          // computes certificates(), whether or not a machine is armed
  std::function<bool()> stop{};  // asked before each tick, and while the clock waits: true ends the run
  std::function<Hand()> hand{};  // asked before each tick
  // Likewise, with the tick's index: what somebody asks for who steers the twin's hand; nothing: no news.
  std::function<std::optional<HandWord>(std::int64_t)> steer{};
  // Called once, when all that can be computed beforehand is: before a device is connected or a file is made.
  std::function<void()> begins{};
  // Hooks, in the order of a tick; an empty one is not called.
  std::function<void(Rig&)> fit_out{};  // once: puts other devices in place of those of the rig
  std::function<void(const Stamped<StereoFrame>&)> look{};  // while reading: each pair of a camera's images
  std::function<void(Inputs&)> disturb{};                   // after reading
  Law law{};                                                // in place of step()
  std::function<void(const Glance&)> watch{};               // after the tick
  std::function<void(double)> progress{};                   // share done, about ten times a second
};

}  // namespace enc::trial
