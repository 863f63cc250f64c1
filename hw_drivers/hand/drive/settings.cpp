#include "hw_drivers/hand/drive/settings.h"

#include <array>
#include <string_view>

#include "hw_drivers/net/socket.h"

namespace enc::hand {

void HandSettings::declare(Settings& table) {
  static constexpr std::array<std::string_view, 2> kTransports{"udp", "tcp"}, kSides{"right", "left"},
      kLandmarks{"wrist", "tracker"};
  table.value({.name = "transport",
               .meaning = "udp: the headset sends to this PC; tcp: this PC connects to the headset",
               .words = kTransports},
              transport);
  table.value(
      {.name = "address", .meaning = "udp: address of this PC's network card; tcp: address of the headset"},
      address);
  table.value({.name = "port", .meaning = "port at that address", .low = 1, .high = 65535}, port);
  table.value({.name = "side", .meaning = "which hand", .words = kSides}, side);
  table.value({.name = "landmarks",
               .meaning = "frame of the joints in the lines: the wrist's, or the tracker's",
               .words = kLandmarks},
              landmarks);
  table.value({.name = "timeout_ms", .meaning = "longest wait for the first hand", .low = 1, .high = 1e5},
              timeout);
  table.value({.name = "silent_ms",
               .meaning = "longest time without a hand; then the link is lost",
               .low = 1,
               .high = 1e5},
              silent);
  table.value({.name = "least_delay_ms",
               .meaning = "time from exposure to arrival of the quickest line",
               .low = 0,
               .high = 1e3,
               .source = "sources/hand 7"},
              least_delay);
  table.value({.name = "skin_mm",
               .meaning = "thickness from a joint to the skin, which the lines lack",
               .low = 0,
               .high = 50,
               .source = "sources/hand 7"},
              skin);
}

std::string HandSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::hand
