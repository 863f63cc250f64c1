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
  table.value({.name = "address", .meaning = "udp: of this PC's card; tcp: of the headset"}, address);
  table.value({.name = "port", .meaning = "at that address", .low = 1, .high = 65535}, port);
  table.value({.name = "side", .meaning = "which hand", .words = kSides}, side);
  table.value({.name = "landmarks",
               .meaning = "what the joints are given in: the wrist's frame, or the tracker's",
               .words = kLandmarks},
              landmarks);
  table.value({.name = "timeout_ms", .meaning = "for its first hand", .low = 1, .high = 1e5}, timeout);
  table.value({.name = "silent_ms", .meaning = "without a hand: the link is lost", .low = 1, .high = 1e5},
              silent);
  table.value({.name = "least_delay_ms",
               .meaning = "from exposure to arrival, of the quickest line",
               .low = 0,
               .high = 1e3,
               .source = "sources/hand 7"},
              least_delay);
  table.value({.name = "skin_mm",
               .meaning = "thickness from a joint to the skin, which the lines do not have",
               .low = 0,
               .high = 50,
               .source = "sources/hand 7"},
              skin);
}

std::string HandSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::hand
