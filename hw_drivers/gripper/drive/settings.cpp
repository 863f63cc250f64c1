#include "hw_drivers/gripper/drive/settings.h"

#include "hw_drivers/net/socket.h"

namespace enc::gripper {

void GripperSettings::declare(Settings& table) {
  table.value({.name = "address", .meaning = "address of the coupler"}, address);
  table.value({.name = "port", .meaning = "Modbus TCP port of the coupler", .low = 1, .high = 65535}, port);
  table.value({.name = "unit", .meaning = "unit identifier of the coupler", .low = 0, .high = 255}, unit);
  table.value({.name = "product", .meaning = "text that the coupler's identity registers must contain"},
              product);
  const auto bit = [&table](const char* name, const char* meaning, std::int64_t& number) {
    table.value({.name = name, .meaning = meaning, .low = 0, .high = 255}, number);
  };
  bit("open_output", "the digital output that opens the jaws", open_output);
  bit("close_output", "the digital output that closes the jaws", close_output);
  bit("open_input", "the digital input of the sensor 'jaws open'", open_input);
  bit("grip_input", "the digital input of the sensor 'tool gripped'", grip_input);
  declare_times(table);
  declare_jaws(table);
}

void GripperSettings::declare_times(Settings& table) {
  table.value({.name = "timeout_ms",
               .meaning = "longest wait for an answer; then the link is lost",
               .low = 1,
               .high = 1e4},
              timeout);
  table.value(
      {.name = "poll_ms", .meaning = "time between two readings of the inputs", .low = 1, .high = 1e3}, poll);
  table.value(
      {.name = "watchdog_ms",
       .meaning = "the coupler's watchdog, set before the first command: after this time without a telegram "
                  "its outputs go to 0",
       .low = 100,
       .high = 1e4},
      watchdog);
  table.value({.name = "rest_ms",
               .meaning = "time with both outputs off between two directions",
               .low = 0,
               .high = 1e3},
              rest);
  table.value(
      {.name = "longest_stroke_ms",
       .meaning =
           "longest time from a command to its sensor; later the jaws have closed on nothing, or are stuck",
       .low = 10,
       .high = 1e4},
      longest_stroke);
}

void GripperSettings::declare_jaws(Settings& table) {
  table.value({.name = "closing_ms",
               .meaning = "time of the whole stroke, from which the opening of moving jaws is estimated",
               .low = 1,
               .high = 1e4,
               .source = "sources/force_sensor 4"},
              closing_time);
  table.value({.name = "stroke_mm",
               .meaning = "stroke of each jaw",
               .low = 0.1,
               .high = 100,
               .source = "sources/force_sensor 4"},
              stroke);
  table.value({.name = "width_mm",
               .meaning = "distance between the jaws where they grip the tool",
               .low = 0,
               .high = 200},
              width);
  table.value({.name = "force_N",
               .meaning = "force that the rotary switch at the gripper is set to; no sensor measures it",
               .low = 1,
               .high = 1e4},
              force);
}

std::string GripperSettings::place() const { return net::place(address, static_cast<std::uint16_t>(port)); }

}  // namespace enc::gripper
