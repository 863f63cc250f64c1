// Tool data over OpenIGTLink (docs/reference/devices.md).
#include "core/devices/module.h"
#include "hw_drivers/igtl/drive/igtl_tracker.h"
#include "hw_drivers/igtl/fake/tool_server.h"

namespace enc::igtl {
namespace {

constexpr DriverModule kDriver{.settings = [](Settings& table) { IgtlSettings{}.declare(table); },
                               .tracker = subscribed,
                               .lockstep = true,
                               .fake = served};
constexpr ModuleInfo kInfo{.name = "igtl", .driver = &kDriver};

}  // namespace
}  // namespace enc::igtl

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::igtl::kInfo;
}
