#include "hw_drivers/gcs/drive/settings.h"

#include <array>
#include <string_view>

#include "hw_drivers/net/socket.h"

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
  static constexpr std::array<std::string_view, 2> kPaths{"points", "own"};
  table.value(
      {.name = "path",
       .meaning =
           "points: straight from one set-point to the next, each in a cycle (SPA 0x19001900 1, SCT); own: "
           "the controller's way to each, as if it were the last",
       .words = kPaths},
      path);
  table.value({.name = "step_um",
               .meaning = "that the machine moves in; with rig.manipulator's servo it tells the acceleration",
               .low = 0,
               .high = 1e3,
               .source = "[VHMR 2]"},
              step);
  table.value({.name = "origin_height_mm",
               .meaning = "of the controller's coordinates above R, all at 0",
               .low = -1e3,
               .high = 1e3,
               .source = "sources/hexapod 2"},
              origin_height);
  table.value({.name = "identity", .meaning = "a part of what it answers to *IDN?"}, identity);
  table.value({.name = "stage", .meaning = "a part of what it answers to CST?: the machine at its axes"},
              stage);
  table.value({.name = "firmware", .meaning = "the least, as 2.10.0.1; empty: any"}, firmware);
}

std::string GcsSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::gcs
