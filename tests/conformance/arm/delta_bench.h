// The driver of a Force Dimension device and the fake libdhd.so in this process, with a fake arm behind it.
#pragma once

#include <memory>

#include "hw_drivers/forcedimension/drive/delta_arm.h"
#include "tests/conformance/arm/arm_bench.h"

namespace enc::test {

// Three slides along x, y and z: a delta moves as such a chain.
inline ArmMachine three_slides() {
  ArmMachine machine;
  machine.kind = ArmKind::chain;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    ChainLink link;
    link.axis = axis;
    machine.links.push_back(link);
  }
  machine.drives.fill({-0.08, 0.08, 100.0, 1e-6});
  return machine;
}

struct DeltaBench : ArmBench {
  struct Table final : ArmTable {
    using ArmTable::value;
    void value(const Setting& key, std::int64_t& whole) override {
      ArmTable::value(key, whole);
      if (key.name == "serial") whole = serial;
    }
    void value(const Setting& key, double& number) override {
      ArmTable::value(key, number);
      if (key.name == "device_watchdog_ms") number = device_watchdog;
    }
    std::int64_t serial = 0;
    double device_watchdog = 0.005;  // s
  };

  DeltaBench() : ArmBench(three_slides(), "Force Dimension", 2) {
    table.serial = server.port();
    table.device_watchdog = 0.031;
    with([&] { arm.joints = {0.01, -0.02, 0.03}; });
  }
  Offer offer() { return {table, defaults.rig, defaults.reach, Duration(1'000'000), log}; }
  std::unique_ptr<HapticArm> open() { return forcedimension::opened(offer()); }

  Table table;
};

}  // namespace enc::test
