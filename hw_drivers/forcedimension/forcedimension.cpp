// A haptic device of Force Dimension over DHD, whose library is loaded at run time
// (docs/reference/devices.md).
#include "core/devices/module.h"
#include "hw_drivers/forcedimension/drive/delta_arm.h"
#include "hw_drivers/forcedimension/drive/settings.h"
#include "hw_drivers/forcedimension/fake/served.h"

namespace enc::forcedimension {
namespace {

constexpr DriverModule kDriver{.settings = [](Settings& table) { ForceDimensionSettings{}.declare(table); },
                               .arm = opened,
                               .fake = served};
constexpr ModuleInfo kInfo{.name = "forcedimension", .driver = &kDriver};

}  // namespace
}  // namespace enc::forcedimension

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::forcedimension::kInfo;
}
