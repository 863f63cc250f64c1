// A driver's offer: a maker for each role of its device, and the keys of its table.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/devices/device.h"
#include "core/spec/rig_spec.h"
#include "core/spec/settings.h"

namespace enc {

class Fake;
struct FakeOffer;

// The driver's messages to the user, printed after the run. Call it from any thread, but never from read(),
// poll(), command() or show(), which must not wait.
class Log {
 public:
  virtual ~Log() = default;
  virtual void say(const std::string& line) = 0;
};

// The arguments of a maker. `log` lives until the device is gone, everything else only during the call.
struct Offer {
  // The driver's own table, [driver.NAME]; all roles of one driver share it.
  Settings& table;
  const RigSpec& rig;  // The rig file's model of each role: rig.manipulator, rig.arm, ...
  const Reach& reach;  // reach of a manipulator by the rig file
  // Period of the loop's clock; read() and poll() pass the present time.
  Duration period;
  Log& log;
  // True: the run waits for slow devices, so that it is repeatable. False: the run keeps the wall clock, and
  // no device may make it wait.
  bool waits = false;
  // True: the peer is also a fake whose time advances with the run, one cycle for each set-point.
  bool lockstep = false;
  std::span<const std::string> tools{};  // the scene's tools: names by index
};

template <class Role>
using Maker = std::unique_ptr<Role> (*)(const Offer& offer);
// Maker of a device whose constructor takes the offer.
template <class Role, class Implementation>
std::unique_ptr<Role> make(const Offer& offer) {
  return std::make_unique<Implementation>(offer);
}

// Roles that the driver does not offer stay null. Makers throw Error (kind device) with a remedy, and move
// nothing.
struct DriverModule {
  void (*settings)(Settings& table) = nullptr;  // declares every key; null: the driver has no keys
  Maker<Manipulator> manipulator = nullptr;
  Maker<HapticArm> arm = nullptr;
  Maker<ForceSensor> force = nullptr;
  Maker<PoseTracker> tracker = nullptr;
  Maker<Display> display = nullptr;
  Maker<Gripper> gripper = nullptr;
  Maker<HandTracker> hand_tracker = nullptr;
  // A camera for a tracker, which reads it; it is not a role of the loop.
  Maker<StereoCamera> camera = nullptr;
  bool plays = false;     // its devices replay recordings and need no wall clock
  bool lockstep = false;  // its devices can keep step with a fake (Offer::lockstep)
  // Makes the stand-in for all its devices (fake.h).
  std::unique_ptr<Fake> (*fake)(const FakeOffer& offer) = nullptr;
};

}  // namespace enc
