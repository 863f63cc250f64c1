// The keys that the drivers of all force-controlled arms have: when a force passes to the device.
#pragma once

#include <cstdint>
#include <string>

#include "core/devices/driver.h"
#include "core/spec/settings.h"
#include "hw_drivers/arm/servo.h"

namespace enc::arm {

struct CommonSettings {
  std::string library;                // empty: the installed one
  std::int64_t dead_man_button = 1;   // 0: no switch
  std::int64_t watchdog_periods = 3;  // of the loop
  double silent = 0.004;              // s
  double timeout = 0.5;               // s
  double rise = 20.0;                 // N/s

  void declare_common(Settings& table);
  [[nodiscard]] ServoSettings servo(const Offer& offer, const ArmAbility& ability) const;
  // True if the dead man's switch is closed, or there is none. `buttons`: bit 0 is button 1.
  [[nodiscard]] bool pressed(std::uint32_t buttons) const noexcept {
    return dead_man_button == 0 || ((buttons >> static_cast<unsigned>(dead_man_button - 1)) & 1U) != 0;
  }
};

}  // namespace enc::arm
