// The driver of a haptic device of Force Dimension over DHD, with a thread of its own.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "core/base/error.h"
#include "core/devices/driver.h"
#include "core/devices/fake.h"
#include "core/machine/arm.h"
#include "hw_drivers/arm/library.h"
#include "hw_drivers/arm/servo.h"
#include "hw_drivers/forcedimension/drive/settings.h"
#include "hw_drivers/forcedimension/wire/dhd.h"

namespace enc::forcedimension {

// The device: found and inspected, its watchdog set, its brakes on.
class DhdDevice {
 public:
  // Throws Error (kind device) with a remedy; moves nothing.
  DhdDevice(const Offer& offer, const ForceDimensionSettings& settings);
  DhdDevice(const DhdDevice&) = delete;
  DhdDevice& operator=(const DhdDevice&) = delete;
  ~DhdDevice();

  [[nodiscard]] std::string describe() const;
  [[nodiscard]] bool is_fake() const { return name_.find(kFakeName) != std::string::npos; }
  [[nodiscard]] const ArmAbility& ability() const noexcept { return ability_; }
  // Reads the arm; waits for its answer. The library may throw.
  [[nodiscard]] arm::ArmReading read();
  // Exerts a force in R; an error is in the next reading.
  void exert(const Vec<'R'>& force);
  void switch_on();            // force on, brakes off
  void switch_off() noexcept;  // force off, brakes on; from any thread
  [[nodiscard]] Error failed(const std::string& what) const;

 private:
  void inspect();
  void set_limits();

  ForceDimensionSettings settings_;
  Arm arm_;
  Point<'R'> origin_;  // of the device's coordinates: the tip with all joints at 0
  arm::Library library_;
  dhd::Functions dhd_;
  char id_ = 0;
  std::string name_;
  int serial_ = 0;
  std::array<int, 4> version_{};
  ArmAbility ability_;
  PerJoint joints_{};
  int error_ = 0;
};

class DhdLoop {
 public:
  DhdLoop(const Offer& offer, const ForceDimensionSettings& settings);
  DhdLoop(const DhdLoop&) = delete;
  DhdLoop& operator=(const DhdLoop&) = delete;
  ~DhdLoop() = default;
  [[nodiscard]] DhdDevice& device() noexcept { return device_; }
  [[nodiscard]] arm::Servo& servo() noexcept { return servo_; }
  // Ends the thread. Returns false if it hangs in the library: this object must then live on.
  [[nodiscard]] bool shut() noexcept;

 private:
  void run() noexcept;
  void turn();

  DhdDevice device_;
  arm::Servo servo_;
  std::atomic<bool> end_ = false, ended_ = false;
  std::thread thread_;
};

// The driver by its table.
[[nodiscard]] std::unique_ptr<HapticArm> opened(const Offer& offer);

}  // namespace enc::forcedimension
