// A PHANToM behind OpenHaptics HD: found, inspected and calibrated, and one frame of it at a time.
#pragma once

#include <array>
#include <string>

#include "core/base/error.h"
#include "core/devices/driver.h"
#include "core/devices/fake.h"
#include "core/machine/arm.h"
#include "hw_drivers/arm/library.h"
#include "hw_drivers/arm/servo.h"
#include "hw_drivers/phantom/drive/settings.h"
#include "hw_drivers/phantom/wire/hd.h"

namespace enc::phantom {

class HdDevice {
 public:
  // Loads the library and opens the device; moves nothing, and leaves its motors off. Throws Error (kind
  // device) with a remedy.
  HdDevice(const Offer& offer, const PhantomSettings& settings);
  HdDevice(const HdDevice&) = delete;
  HdDevice& operator=(const HdDevice&) = delete;
  ~HdDevice();  // gives the device back

  [[nodiscard]] const hd::Functions& hd() const noexcept { return hd_; }
  [[nodiscard]] const PhantomSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] std::string describe() const;
  [[nodiscard]] bool is_fake() const { return vendor_.find(kFakeName) != std::string::npos; }
  [[nodiscard]] const ArmAbility& ability() const noexcept { return ability_; }

  // Checks the calibration, or calibrates. Throws Error (kind device) for an arm that is not calibrated.
  void calibrate();
  // Distance of the tip that the device reported in the last frame from that of the rig's arm at its joints,
  // m.
  [[nodiscard]] double apart(const arm::ArmReading& reading) const noexcept;
  // Throws Error (kind device) if that distance is too large: another arm, or a wrong calibration.
  void compare(double apart) const;

  // One frame: reads the arm, and exerts the force that `law` returns, in R. The library may throw.
  // `at`: steady clock; `dt`: time between two frames, s; unset: by the clock.
  template <class Law>
  arm::ArmReading frame(Duration at, double dt, Law law) {
    hd_.begin_frame(handle_);
    const arm::ArmReading reading = read(at, dt);
    exert(law(reading));
    end_frame();
    return reading;
  }
  // One frame that only reads, and one that only exerts a force: for a device without a thread of its own.
  arm::ArmReading look(Duration at, double dt);
  void push(const Vec<'R'>& force);
  // The number of the last frame's error; it is also in the next reading.
  [[nodiscard]] int error() const noexcept { return error_; }

  void switch_on();            // motors; with zero force until the next frame
  void switch_off() noexcept;  // from any thread

  [[nodiscard]] Error failed(const std::string& what) const;  // with the device's name

 private:
  void open();
  void ask();
  // Throws Error (kind device) unless the device's time goes on as the run's does.
  void check_time(bool lockstep) const;
  [[nodiscard]] arm::ArmReading read(Duration at, double dt);
  void find_velocities(arm::ArmReading& reading, double dt);
  void exert(const Vec<'R'>& force);
  void end_frame();

  // Joints of the last frames, a ring.
  static constexpr std::size_t kLongest = 64;
  struct JointSample {
    PerJoint joints{};
    Duration at{};
  };

  PhantomSettings settings_;
  Arm arm_;
  std::int64_t window_;  // frames
  arm::Library library_;
  hd::Functions hd_;
  hd::Handle handle_ = hd::kNoDevice;
  std::string vendor_, model_, serial_, driver_version_, version_;
  ArmAbility ability_;
  Point<'R'> origin_;
  Vec3 reported_mm_ = Vec3::Zero();  // position of the last frame, in the device's coordinates
  std::array<JointSample, kLongest> kept_{};
  std::int64_t frames_ = 0;
  int error_ = 0;
  bool has_warmth_ = false;  // the device reports the temperature of its motors
};

}  // namespace enc::phantom
