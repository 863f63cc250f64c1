#include "hw_drivers/forcedimension/drive/settings.h"

namespace enc::forcedimension {

void ForceDimensionSettings::declare(Settings& table) {
  declare_common(table);
  table.value({.name = "serial",
               .meaning = "number of the device; of the fake: its port; 0: the first device",
               .low = 0,
               .high = 65535},
              serial);
  table.value(
      {.name = "device_watchdog_ms",
       .meaning = "time limit in the device's firmware: after this time without a force it ends the force",
       .low = 1,
       .high = 31},
      device_watchdog);
}

arm::Place ForceDimensionSettings::fake_place() const {
  return {"127.0.0.1", serial == 0 ? kUsualPort : static_cast<std::uint16_t>(serial)};
}

}  // namespace enc::forcedimension
