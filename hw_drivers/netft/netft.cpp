// A force/torque sensor on an ATI Net Box, over UDP and HTTP (docs/reference/devices.md).
#include "core/devices/module.h"
#include "hw_drivers/netft/drive/netft_sensor.h"
#include "hw_drivers/netft/fake/server.h"

namespace enc::netft {
namespace {

constexpr DriverModule kDriver{.settings = [](Settings& table) { NetftSettings{}.declare(table); },
                               .force = streaming,
                               .lockstep = true,
                               .fake = served};
constexpr ModuleInfo kInfo{.name = "netft", .driver = &kDriver};

}  // namespace
}  // namespace enc::netft

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::netft::kInfo;
}
