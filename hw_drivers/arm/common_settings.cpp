#include "hw_drivers/arm/common_settings.h"

namespace enc::arm {

void CommonSettings::declare_common(Settings& table) {
  table.value({.name = "library",
               .meaning = "file of the vendor's library; \"fake\": the stand-in; empty: the installed one"},
              library);
  table.value({.name = "dead_man_button",
               .meaning = "number of the button that must be held for any force; 0: none",
               .low = 0,
               .high = 4},
              dead_man_button);
  table.value({.name = "watchdog_periods",
               .meaning = "periods of the loop without a command, after which the force is zero",
               .low = 2,
               .high = 1000},
              watchdog_periods);
  table.value({.name = "silent_ms",
               .meaning = "longest time between two turns of the device's thread; then the force is off and "
                          "the link is lost",
               .low = 2,
               .high = 1e3},
              silent);
  table.value({.name = "timeout_ms",
               .meaning = "longest wait for the first turn of the device's thread",
               .low = 10,
               .high = 1e4},
              timeout);
  table.value({.name = "ramp_N_per_s",
               .meaning = "growth of the largest force after each start; 0: at once",
               .low = 0,
               .high = 1e4},
              rise);
}

ServoSettings CommonSettings::servo(const Offer& offer, const ArmAbility& ability) const {
  ServoSettings of;
  of.guard.watchdog = static_cast<double>(watchdog_periods) * seconds(offer.period);
  of.guard.rise = rise;
  of.guard.most = ability.peak;
  of.silent = silent;
  return of;
}

}  // namespace enc::arm
