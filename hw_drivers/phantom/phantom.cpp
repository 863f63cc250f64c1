// A PHANToM over OpenHaptics HD, whose library is loaded at run time (docs/reference/devices.md).
#include "core/devices/module.h"
#include "hw_drivers/phantom/drive/phantom_arm.h"
#include "hw_drivers/phantom/drive/settings.h"
#include "hw_drivers/phantom/fake/served.h"

namespace enc::phantom {
namespace {

constexpr DriverModule kDriver{.settings = [](Settings& table) { PhantomSettings{}.declare(table); },
                               .arm = opened,
                               .lockstep = true,
                               .fake = served};
constexpr ModuleInfo kInfo{.name = "phantom", .driver = &kDriver};

}  // namespace
}  // namespace enc::phantom

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::phantom::kInfo;
}
