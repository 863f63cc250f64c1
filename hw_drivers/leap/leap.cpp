// A hand tracker of Ultraleap over LeapC, whose library is loaded at run time (docs/reference/devices.md).
#include "core/devices/module.h"
#include "hw_drivers/leap/drive/leap_tracker.h"
#include "hw_drivers/leap/drive/settings.h"
#include "hw_drivers/leap/fake/served.h"

namespace enc::leap {
namespace {

constexpr DriverModule kDriver{.settings = [](Settings& table) { LeapSettings{}.declare(table); },
                               .hand_tracker = opened,
                               .fake = served};
constexpr ModuleInfo kInfo{.name = "leap", .driver = &kDriver};

}  // namespace
}  // namespace enc::leap

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::leap::kInfo;
}
