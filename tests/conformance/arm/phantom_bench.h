// The driver of a PHANToM and the fake libHD.so in this process, with a fake arm behind it.
#pragma once

#include <memory>
#include <string>

#include "hw_drivers/phantom/drive/phantom_arm.h"
#include "tests/conformance/arm/arm_bench.h"

namespace enc::test {

struct PhantomBench : ArmBench {
  struct Table final : ArmTable {
    using ArmTable::value;
    void value(const Setting& key, std::string& text) override {
      ArmTable::value(key, text);
      if (key.name == "device") text = device;
      if (key.name == "calibration") text = calibration;
    }
    std::string device, calibration = "check";
  };

  PhantomBench() : ArmBench(ArmMachine{}, "PHANToM", phantom::hd::kWarmMotors) {
    table.device = "127.0.0.1:" + std::to_string(server.port());
  }
  Offer offer() { return {table, defaults.rig, defaults.reach, Duration(1'000'000), log}; }
  std::unique_ptr<HapticArm> open() { return phantom::opened(offer()); }

  Table table;
};

}  // namespace enc::test
