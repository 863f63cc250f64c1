// [driver.forcedimension] of a rig file.
#pragma once

#include <cstdint>
#include <string>

#include "core/spec/settings.h"
#include "hw_drivers/arm/common_settings.h"
#include "hw_drivers/arm/fake/message.h"

namespace enc::forcedimension {

struct ForceDimensionSettings : arm::CommonSettings {
  std::int64_t serial = 0;         // 0: the first device
  double device_watchdog = 0.005;  // s; of the device's firmware

  void declare(Settings& table);
  [[nodiscard]] arm::Place fake_place() const;
};

// The port of a fake for serial 0; the variable ENCOUNTER_FAKE_DHD of the environment replaces the place.
inline constexpr std::uint16_t kUsualPort = 18971;
inline constexpr const char* kPlaceVariable = "ENCOUNTER_FAKE_DHD";

}  // namespace enc::forcedimension
