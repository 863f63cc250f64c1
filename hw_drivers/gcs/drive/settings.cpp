#include "hw_drivers/gcs/drive/settings.h"

#include <array>
#include <string_view>

#include "hw_drivers/net/socket.h"

namespace enc::gcs {

void GcsSettings::declare(Settings& table) {
  table.value({.name = "address", .meaning = "address of the controller"}, address);
  table.value({.name = "port", .meaning = "TCP port of the controller", .low = 1, .high = 65535}, port);
  table.value({.name = "timeout_ms",
               .meaning = "longest time for an answer; then the link is lost",
               .low = 1,
               .high = 1e4},
              timeout);
  table.value({.name = "cycle_ms", .meaning = "time between two set-points (MOV)", .low = 1, .high = 1e3},
              cycle);
  table.value({.name = "poll_ms", .meaning = "time between two position queries", .low = 1, .high = 1e3},
              poll);
  table.value({.name = "watchdog_ms",
               .meaning = "time without a command of the loop, at least three of its cycles, after which the "
                          "driver stops the machine",
               .low = 1,
               .high = 1e3},
              watchdog);
  table.value(
      {.name = "velocity_mm_s",
       .meaning = "velocity set in the controller (VLS) before the first motion; 0: the controller's own",
       .low = 0,
       .high = 1e3},
      velocity);
  static constexpr std::array<std::string_view, 2> kPaths{"points", "own"};
  table.value(
      {.name = "path",
       .meaning = "points: straight from one set-point to the next, each in a cycle (SPA 0x19001900 1, SCT); "
                  "own: the controller's own profile to each set-point, as if it were the last",
       .words = kPaths},
      path);
  table.value(
      {.name = "step_um",
       .meaning = "smallest step of the machine; with the servo of rig.manipulator it gives the acceleration",
       .low = 0,
       .high = 1e3,
       .source = "[VHMR 2]"},
      step);
  table.value(
      {.name = "origin_height_mm",
       .meaning = "height above R of the origin of the controller's coordinates, with all of them at 0",
       .low = -1e3,
       .high = 1e3,
       .source = "sources/hexapod 2"},
      origin_height);
  table.value({.name = "identity", .meaning = "part of the controller's answer to *IDN?"}, identity);
  table.value(
      {.name = "stage", .meaning = "part of the controller's answer to CST?: the machine on its axes"},
      stage);
  table.value({.name = "firmware", .meaning = "oldest accepted firmware, such as 2.10.0.1; empty: any"},
              firmware);
}

std::string GcsSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::gcs
