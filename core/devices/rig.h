// The devices of an experiment, one slot for each role of the loop, and the clock that drives it.
#pragma once

#include <memory>

#include "core/base/time.h"
#include "core/devices/device.h"
#include "core/devices/signals.h"

namespace enc {

// Lateness of a wall clock; a lag of less than one cycle does not count.
struct Lateness {
  std::int64_t times = 0;             // number of late ticks
  double total = 0.0, longest = 0.0;  // s
};

// The clock drives the loop: a simulated clock advances its world by one period, a machine's clock waits for
// the cycle.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Tick next() = 0;
  // Cycles without a tick since the last next(); the index of that tick is higher by this number. A lockstep
  // clock is never late: 0.
  [[nodiscard]] virtual std::int64_t missed() const noexcept { return 0; }
  // Totals since the start.
  [[nodiscard]] virtual Lateness lateness() const noexcept { return {}; }
};

// The devices of an experiment, one slot for each role of the loop. A slot is empty if the scene does not
// need the device. Commands to the devices go through the gate (trial/gate.h).
struct Rig {
  std::unique_ptr<Clock> clock;
  std::unique_ptr<Manipulator> manipulator;
  std::unique_ptr<HapticArm> arm;
  std::unique_ptr<ForceSensor> force;
  std::unique_ptr<PoseTracker> tracker;
  std::unique_ptr<Display> display;
  std::unique_ptr<Gripper> gripper;
  std::unique_ptr<HandTracker> hand_tracker;  // not of the loop: no Inputs, no hold

  // Reads the devices' data for this cycle. A device without its own clock stamps with `now`.
  void read(Time now, Inputs& in) noexcept {
    in.missed = clock->missed();
    if (manipulator) in.tip = manipulator->read(now);
    if (arm) in.arm = arm->read(now);
    if (force) in.wrench = force->read(now);
    if (tracker) tracker->poll(now, in.tool);
    if (display) display->poll(now, in.dent);
    if (gripper) in.grip = gripper->read(now);
  }
};

}  // namespace enc
