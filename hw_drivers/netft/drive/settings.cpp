#include "hw_drivers/netft/drive/settings.h"

#include "hw_drivers/net/socket.h"

namespace enc::netft {

void NetftSettings::declare(Settings& table) {
  table.value({.name = "address", .meaning = "address of the Net Box"}, address);
  table.value({.name = "port", .meaning = "UDP port of the records (RDT)", .low = 1, .high = 65535}, port);
  table.value({.name = "http_port", .meaning = "TCP port of the web pages", .low = 1, .high = 65535},
              http_port);
  table.value({.name = "command_port",
               .meaning = "TCP port of the command interface, whose units must be the page's; 0: do not ask",
               .low = 0,
               .high = 65535},
              command_port);
  table.value(
      {.name = "timeout_ms", .meaning = "longest time for page and first record", .low = 1, .high = 1e4},
      timeout);
  table.value({.name = "silent_ms", .meaning = "silence after which the link is lost", .low = 1, .high = 1e4},
              silent);
  table.value({.name = "range_N",
               .meaning = "force that the box's calibration must reach along each axis",
               .low = 0,
               .high = 1e5,
               .source = "[VHMR 2]"},
              range);
  table.value({.name = "torque_range_Nm",
               .meaning = "torque that the box's calibration must reach about each axis",
               .low = 0,
               .high = 1e5},
              torque_range);
  table.value(
      {.name = "least_delay_ms",
       .meaning = "delay of the quickest record from conversion to arrival, including the box's filter",
       .low = 0,
       .high = 1e3},
      least_delay);
  table.value({.name = "counter_Hz",
               .meaning = "rate of the box's sample counter; 0: measured from the first records",
               .low = 0,
               .high = 1e6},
              counter);
  table.value({.name = "product", .meaning = "part of the box's product name (prodname)"}, product);
}

std::string NetftSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::netft
