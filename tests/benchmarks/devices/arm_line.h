// An arm's driver with its thread, the vendor's fake library and the twin's arm behind it, in virtual time:
// the drivers' clock stands from tick to tick, and each tick waits for the library's answer.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/devices/rig.h"
#include "core/spec/rig_spec.h"
#include "hw_drivers/arm/fake/server.h"
#include "trial/devices/device_log.h"

namespace enc::bench::devices {

enum class Vendor : std::uint8_t { phantom, forcedimension };
// The vendor's library calls the driver in each tick, hangs, or gets bytes that are no state.
enum class LibraryState : std::uint8_t { calls, hangs, hears_noise };

class ArmLine {
 public:
  // `firmware`: watchdog of the device, s. `keeps_force`: the device exerts its last force instead of zero.
  ArmLine(Vendor vendor, const RigSpec& spec, double firmware, bool keeps_force)
      : vendor_(vendor), spec_(spec), firmware_(firmware), keeps_force_(keeps_force) {}
  ~ArmLine() = default;
  ArmLine(const ArmLine&) = delete;
  ArmLine& operator=(const ArmLine&) = delete;

  // Wraps the rig's arm and clock. Destroy the rig before this object.
  void fit_out(Rig& rig);
  // Puts the driver between the loop and the twin's arm. Until then the loop has the arm itself.
  void connect();
  void disconnect();  // the driver ends, while the twin's arm is still there
  [[nodiscard]] arm::ArmServer& server() { return *server_; }
  [[nodiscard]] std::string said() const;
  void library(LibraryState state) { library_ = state; }
  // Delays the next tick by this time, and its clock misses that many cycles. If `process` is true, the
  // device's thread stands, too.
  void stand(Duration how_long, bool process) {
    standing_ = how_long;
    process_stands_ = process;
  }
  // ms from the begin of the last stand to its last tick in which the arm had force.
  [[nodiscard]] int force_in_stand() const { return force_in_stand_; }
  std::function<bool()> exerts;  // the twin's motors have torque

 private:
  class Slot;
  class ForceKeeper;
  class LineClock;
  template <class Act>
  void serve_while(Act act);
  void pass(Time now);
  void exchange(Time now);
  void await_loss(Time now);

  Vendor vendor_;
  RigSpec spec_;
  double firmware_;
  bool keeps_force_;
  trial::DeviceLog log_;
  std::unique_ptr<HapticArm> twin_, driver_, keeper_;
  std::unique_ptr<arm::ArmServer> server_;
  Time now_{};
  Duration base_{}, standing_{};  // base_: the drivers' clock at the loop's time 0
  std::int64_t quiet_ = 0;        // ticks since the library's last call
  LibraryState library_ = LibraryState::calls;
  int force_in_stand_ = 0;
  bool process_stands_ = false, never_lost_ = false;
};

}  // namespace enc::bench::devices
