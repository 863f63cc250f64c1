// What a driver offers: a maker for each role that its device fills, and the keys of its table.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/devices/display.h"
#include "core/devices/force_sensor.h"
#include "core/devices/gripper.h"
#include "core/devices/haptic_arm.h"
#include "core/devices/manipulator.h"
#include "core/devices/pose_tracker.h"
#include "core/devices/stereo_camera.h"
#include "core/spec/rig_spec.h"
#include "core/spec/settings.h"

namespace enc {

class Fake;
struct FakeOffer;

// What a driver has to tell a person: printed when the run is over. From any thread, but never from read(),
// poll(), command() or show(), which must not wait.
class Log {
 public:
  virtual ~Log() = default;
  virtual void say(const std::string& line) = 0;
};

// What the trial gives to whoever makes a device. `log` stays until the device is gone, the rest for the
// call.
struct Offer {
  Settings& table;     // the driver's own, [driver.NAME]; all roles of one driver share it
  const RigSpec& rig;  // what the core believes of each role: rig.manipulator, rig.arm, ...
  const Reach& reach;  // what the rig file promises of a manipulator
  Duration period;     // of the loop's clock; what time it is comes with each read() and poll()
  Log& log;
  // The run waits for whoever is slow, so that it can be repeated; else it keeps the wall clock and nobody
  // may make it wait.
  bool waits = false;
  // And what answers is a fake whose time goes on with the run's, a cycle with each set-point.
  bool lockstep = false;
  std::span<const std::string> tools{};  // names of the scene's, by index
};

template <class Role>
using Maker = std::unique_ptr<Role> (*)(const Offer& offer);
// The maker of a device whose constructor takes the offer.
template <class Role, class Made>
std::unique_ptr<Role> make(const Offer& offer) {
  return std::make_unique<Made>(offer);
}

// What it does not offer stays null. Makers throw Error (kind device) with a way out, and move nothing.
struct DriverModule {
  void (*settings)(Settings& table) = nullptr;  // declares every key; null: the driver has none
  Maker<Manipulator> manipulator = nullptr;
  Maker<HapticArm> arm = nullptr;
  Maker<ForceSensor> force = nullptr;
  Maker<PoseTracker> tracker = nullptr;
  Maker<Display> display = nullptr;
  Maker<Gripper> gripper = nullptr;
  Maker<StereoCamera> camera = nullptr;  // for a tracker that looks through it: no role of the loop
  bool plays = false;                    // its devices play what was recorded: they need no wall clock
  bool lockstep = false;                 // its devices can keep step with a fake (Offer::lockstep)
  std::unique_ptr<Fake> (*fake)(const FakeOffer& offer) = nullptr;  // what stands in for them all (fake.h)
};

}  // namespace enc
