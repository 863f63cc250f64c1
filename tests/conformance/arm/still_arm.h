// An arm for tests of drivers, and the keys of their tables.
#pragma once

#include <cstdint>
#include <string>

#include "core/devices/device.h"
#include "core/machine/arm.h"
#include "tests/support/devices.h"

namespace enc::test {

// An arm that stands at its joints, whatever the force.
struct StillArm final : HapticArm {
  [[nodiscard]] ArmAbility ability() const override { return {arm.machine(), 8.5, 1.4}; }
  Measurement<ArmSample> read(Time now) noexcept override {
    ArmSample sample;
    sample.joints = joints;
    sample.tip = arm.tip(joints);
    sample.velocity = Vec<'R'>(0.1, -0.2, 0.3);
    return {sample, now, Health::ok};
  }
  void command(const Vec<'R'>& commanded) noexcept override { force = commanded; }
  void stop() noexcept override { force = Vec<'R'>::zero(); }

  explicit StillArm(const ArmMachine& machine) : arm(machine) {}

  Arm arm;
  PerJoint joints{0.1, -0.2, 0.3};
  Vec<'R'> force = Vec<'R'>::zero();
};

// The keys that all these drivers have, for a busy machine.
struct ArmTable : DefaultOffer::Defaults {
  using DefaultOffer::Defaults::value;
  void value(const Setting& key, double& number) override {
    if (key.name == "silent_ms") number = silent;
    if (key.name == "ramp_N_per_s") number = rise;
  }
  void value(const Setting& key, std::int64_t& whole) override {
    if (key.name == "watchdog_periods") whole = watchdog_periods;
  }
  void value(const Setting& key, std::string& text) override {
    if (key.name == "library") text = library;
  }
  double silent = 1.0;  // s
  double rise = 0.0;    // N/s
  std::int64_t watchdog_periods = 1000;
  std::string library = "fake";
};

}  // namespace enc::test
