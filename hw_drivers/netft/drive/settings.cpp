#include "hw_drivers/netft/drive/settings.h"

#include "hw_drivers/net/socket.h"

namespace enc::netft {

void NetftSettings::declare(Settings& table) {
  table.value({.name = "address", .meaning = "of the Net Box"}, address);
  table.value({.name = "port", .meaning = "of its records (RDT), UDP", .low = 1, .high = 65535}, port);
  table.value({.name = "http_port", .meaning = "of its pages, TCP", .low = 1, .high = 65535}, http_port);
  table.value(
      {.name = "command_port",
       .meaning = "of its command interface, TCP, which is asked whether it means the same; 0: not asked",
       .low = 0,
       .high = 65535},
      command_port);
  table.value({.name = "timeout_ms", .meaning = "for its page and its first record", .low = 1, .high = 1e4},
              timeout);
  table.value({.name = "silent_ms", .meaning = "without a record: the link is lost", .low = 1, .high = 1e4},
              silent);
  table.value({.name = "range_N",
               .meaning = "that its calibration must reach, along each axis",
               .low = 0,
               .high = 1e5,
               .source = "[VHMR 2]"},
              range);
  table.value({.name = "torque_range_Nm", .meaning = "likewise, about each axis", .low = 0, .high = 1e5},
              torque_range);
  table.value({.name = "least_delay_ms",
               .meaning = "from conversion to arrival, of the quickest record, its filter included",
               .low = 0,
               .high = 1e3},
              least_delay);
  table.value({.name = "counter_Hz",
               .meaning = "how fast it counts its samples; 0: found from its first records",
               .low = 0,
               .high = 1e6},
              counter);
  table.value({.name = "product", .meaning = "a part of what it says that it is (prodname)"}, product);
}

std::string NetftSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::netft
