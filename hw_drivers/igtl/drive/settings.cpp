#include "hw_drivers/igtl/drive/settings.h"

#include <array>

#include "hw_drivers/net/socket.h"

namespace enc::igtl {
namespace {

constexpr std::array<std::string_view, 2> kTransports{"udp", "tcp"}, kMessages{"TRANSFORM", "TDATA"};

}  // namespace

void IgtlSettings::declare(Settings& table) {
  table.value({.name = "address", .meaning = "address of the tool data server"}, address);
  table.value({.name = "port", .meaning = "port of the server; PLUS has 18944", .low = 1, .high = 65535},
              port);
  table.value({.name = "transport",
               .meaning = "udp: datagrams on request; tcp: stream of a tracker's own server",
               .words = kTransports},
              transport);
  table.value({.name = "message",
               .meaning = "message that the driver requests over tcp; TRANSFORM and POSITION need no request",
               .words = kMessages},
              message);
  table.value(
      {.name = "timeout_ms", .meaning = "longest time for the server's first answer", .low = 1, .high = 1e4},
      timeout);
  table.value({.name = "silent_ms",
               .meaning = "time without any message after which the link is lost; with no tool in view the "
                          "server must send a status",
               .low = 1,
               .high = 1e5},
              silent);
  table.value({.name = "least_delay_ms",
               .meaning = "delay of the quickest message from exposure to arrival, which relates the "
                          "tracker's clock to this one",
               .low = 0,
               .high = 1e3},
              least_delay);
  table.value(
      {.name = "suffix",
       .meaning = "suffix of a device name after the tool's name; a device name without it is accepted too"},
      suffix);
}

std::string IgtlSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::igtl
