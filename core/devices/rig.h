// The devices of an experiment, one slot for each role of the loop. A slot is empty if the scene does not
// need the device. Commands to the devices go through the gate (trial/gate.h).
#pragma once

#include <memory>

#include "core/devices/clock.h"
#include "core/devices/display.h"
#include "core/devices/force_sensor.h"
#include "core/devices/gripper.h"
#include "core/devices/haptic_arm.h"
#include "core/devices/manipulator.h"
#include "core/devices/pose_tracker.h"
#include "core/devices/signals.h"

namespace enc {

struct Rig {
  std::unique_ptr<Clock> clock;
  std::unique_ptr<Manipulator> manipulator;
  std::unique_ptr<HapticArm> arm;
  std::unique_ptr<ForceSensor> force;
  std::unique_ptr<PoseTracker> tracker;
  std::unique_ptr<Display> display;
  std::unique_ptr<Gripper> gripper;

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
