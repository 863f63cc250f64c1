// The drivers of a PHANToM over OpenHaptics HD: with the device's scheduler, and in lockstep with the fake.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/devices/driver.h"
#include "hw_drivers/phantom/drive/hd_device.h"

namespace enc::phantom {

// The device and its scheduler, whose thread calls frame() at the device's rate.
class HdLoop {
 public:
  // Starts the scheduler and waits for its first call. Throws Error (kind device).
  HdLoop(const Offer& offer, const PhantomSettings& settings);
  HdLoop(const HdLoop&) = delete;
  HdLoop& operator=(const HdLoop&) = delete;
  ~HdLoop() = default;

  [[nodiscard]] HdDevice& device() noexcept { return device_; }
  [[nodiscard]] arm::Servo& servo() noexcept { return servo_; }
  // Ends the scheduler. Returns false if its thread does not come back: this object must then live on.
  [[nodiscard]] bool shut() noexcept;

 private:
  void start(const PhantomSettings& settings);
  unsigned frame() noexcept;

  HdDevice device_;
  arm::Servo servo_;
  unsigned long callback_ = 0;
  std::int64_t frames_ = 0;          // data of the scheduler's thread
  std::atomic<double> apart_ = 0.0;  // m, in the first frame
  std::atomic<bool> end_ = false, scheduled_ = false;
  std::atomic<bool> done_ = false;  // the last call has ended
};

// Driver for the fake library whose time advances by a period with each force. The loop makes each frame
// itself, so that a run is the same each time. Without a wall clock it has neither ramp nor watchdog.
class LockstepArm final : public HapticArm {
 public:
  LockstepArm(const Offer& offer, const PhantomSettings& settings);

  [[nodiscard]] std::string describe() const override { return device_.describe(); }
  [[nodiscard]] bool is_fake() const override { return device_.is_fake(); }
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] ArmAbility ability() const override { return device_.ability(); }
  Measurement<ArmSample> read(Time now) noexcept override;
  void command(const Vec<'R'>& force) noexcept override;
  void stop() noexcept override;

 private:
  void lose(const std::string& why) noexcept;

  HdDevice device_;
  Log& log_;
  double period_;  // s
  bool linked_ = true, on_ = false;
  Health health_ = Health::ok;  // of the last command
};

// The driver by its table.
[[nodiscard]] std::unique_ptr<HapticArm> opened(const Offer& offer);

}  // namespace enc::phantom
