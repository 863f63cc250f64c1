// A two-finger gripper (Schunk EGP 50) on digital terminals of a Modbus TCP coupler
// (docs/reference/devices.md).
#include "core/devices/module.h"
#include "hw_drivers/gripper/drive/modbus_gripper.h"
#include "hw_drivers/gripper/fake/server.h"

namespace enc::gripper {
namespace {

constexpr DriverModule kDriver{.settings = [](Settings& table) { GripperSettings{}.declare(table); },
                               .gripper = connected,
                               .lockstep = true,
                               .fake = served};
constexpr ModuleInfo kInfo{.name = "gripper", .driver = &kDriver};

}  // namespace
}  // namespace enc::gripper

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::gripper::kInfo;
}
