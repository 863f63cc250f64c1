#include "hw_drivers/gcs/drive/settings.h"

namespace enc::gcs {

void GcsSettings::declare(Settings& table) {
  table.value({.name = "address", .meaning = "of the controller"}, address);
  table.value({.name = "port", .meaning = "of the controller, TCP", .low = 1, .high = 65535}, port);
  table.value(
      {.name = "timeout_ms", .meaning = "for an answer; later, the link is lost", .low = 1, .high = 1e4},
      timeout);
  table.value({.name = "cycle_ms", .meaning = "between two set-points (MOV)", .low = 1, .high = 1e3}, cycle);
  table.value({.name = "poll_ms", .meaning = "between two questions for the position", .low = 1, .high = 1e3},
              poll);
  table.value(
      {.name = "watchdog_ms",
       .meaning = "without a command of the loop, three of its cycles at least: the machine is stopped",
       .low = 1,
       .high = 1e3},
      watchdog);
  table.value({.name = "velocity_mm_s",
               .meaning = "told to the controller (VLS) before it moves; 0: the one it has",
               .low = 0,
               .high = 1e3},
              velocity);
  table.value({.name = "origin_height_mm",
               .meaning = "of the controller's coordinates above R, all at 0",
               .low = -1e3,
               .high = 1e3,
               .source = "sources/hexapod 2"},
              origin_height);
  table.value({.name = "identity", .meaning = "a part of what it answers to *IDN?"}, identity);
  table.value({.name = "firmware", .meaning = "the least, as 2.10.0.1; empty: any"}, firmware);
}

}  // namespace enc::gcs
