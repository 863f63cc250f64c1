// A hexapod on a PI C-887 controller, over GCS 2.0 and TCP (docs/reference/devices.md).
#include "core/devices/module.h"
#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "hw_drivers/gcs/drive/settings.h"
#include "hw_drivers/gcs/fake/server.h"

namespace enc::gcs {
namespace {

constexpr DriverModule kDriver{.settings = [](Settings& table) { GcsSettings{}.declare(table); },
                               .manipulator = connected,
                               .lockstep = true,
                               .fake = served};
constexpr ModuleInfo kInfo{.name = "gcs", .driver = &kDriver};

}  // namespace
}  // namespace enc::gcs

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::gcs::kInfo;
}
