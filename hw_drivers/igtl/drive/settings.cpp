#include "hw_drivers/igtl/drive/settings.h"

#include "hw_drivers/net/socket.h"

namespace enc::igtl {

void IgtlSettings::declare(Settings& table) {
  table.value({.name = "address", .meaning = "of the server of tool data"}, address);
  table.value({.name = "port", .meaning = "of the server, UDP", .low = 1, .high = 65535}, port);
  table.value({.name = "timeout_ms", .meaning = "for its first answer", .low = 1, .high = 1e4}, timeout);
  table.value({.name = "silent_ms",
               .meaning = "without any datagram: the link is lost. While no tool is in view it says so",
               .low = 1,
               .high = 1e5},
              silent);
  table.value(
      {.name = "least_delay_ms",
       .meaning = "from exposure to arrival, of the quickest datagram: how its clock is tied to this one",
       .low = 0,
       .high = 1e3},
      least_delay);
  table.value({.name = "suffix", .meaning = "of a device name behind the name of the tool"}, suffix);
}

std::string IgtlSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::igtl
