// Hand tracking of a headset, in lines of text over UDP or TCP (docs/reference/devices.md).
#include "core/devices/module.h"
#include "hw_drivers/hand/drive/line_tracker.h"
#include "hw_drivers/hand/fake/server.h"

namespace enc::hand {
namespace {

constexpr DriverModule kDriver{.settings = [](Settings& table) { HandSettings{}.declare(table); },
                               .hand_tracker = listening,
                               .lockstep = true,
                               .fake = served};
constexpr ModuleInfo kInfo{.name = "hand", .driver = &kDriver};

}  // namespace
}  // namespace enc::hand

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::hand::kInfo;
}
