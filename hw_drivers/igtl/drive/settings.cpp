#include "hw_drivers/igtl/drive/settings.h"

#include <array>

#include "hw_drivers/net/socket.h"

namespace enc::igtl {
namespace {

constexpr std::array<std::string_view, 2> kTransports{"udp", "tcp"}, kMessages{"TRANSFORM", "TDATA"};

}  // namespace

void IgtlSettings::declare(Settings& table) {
  table.value({.name = "address", .meaning = "of the server of tool data"}, address);
  table.value({.name = "port", .meaning = "of the server; of PLUS it is 18944", .low = 1, .high = 65535},
              port);
  table.value({.name = "transport",
               .meaning = "datagrams to who asks (udp), or the stream of a tracker's own server (tcp)",
               .words = kTransports},
              transport);
  table.value({.name = "message",
               .meaning = "of tcp: what is asked for; TRANSFORM and POSITION are taken without a question",
               .words = kMessages},
              message);
  table.value({.name = "timeout_ms", .meaning = "for its first answer", .low = 1, .high = 1e4}, timeout);
  table.value({.name = "silent_ms",
               .meaning = "without any message: the link is lost. While no tool is in view it says so",
               .low = 1,
               .high = 1e5},
              silent);
  table.value(
      {.name = "least_delay_ms",
       .meaning = "from exposure to arrival, of the quickest message: how its clock is tied to this one",
       .low = 0,
       .high = 1e3},
      least_delay);
  table.value(
      {.name = "suffix",
       .meaning = "of a device name behind the name of the tool; a device may have the tool's name, too"},
      suffix);
}

std::string IgtlSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::igtl
