// A Net Box as its clients see it, in front of any force sensor of the core. It uses neither sockets nor
// clocks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/devices/force_sensor.h"
#include "hw_drivers/netft/drive/counter_rate.h"
#include "hw_drivers/netft/wire/configuration.h"
#include "hw_drivers/netft/wire/record.h"

namespace enc::netft {

// A Gamma SI-130-10 on a box that sends a record each millisecond.
[[nodiscard]] Configuration gamma();

class Box {
 public:
  Box(ForceSensor& sensor, const Configuration& configuration) : sensor_(sensor), of_(configuration) {}

  // Takes a request, or other bytes; true: a record must be sent at once.
  bool take(std::span<const std::byte> request) noexcept;
  [[nodiscard]] bool streams() const noexcept { return streams_; }
  [[nodiscard]] Record record(Time now) noexcept;  // the next record
  // Answer to 20 bytes of the command interface; empty: unknown command.
  [[nodiscard]] std::vector<std::byte> answer(std::span<const std::byte> question, Time now);
  [[nodiscard]] std::string xml() const { return xml_of(of_); }
  // Test aid: counts at the rate of another box, Hz.
  void count_at(double rate) noexcept { counter_rate_ = rate; }
  // Test aid: status of each record from now on; 0: no fault.
  void fail(std::uint32_t status) noexcept { failure_ = status; }

 private:
  ForceSensor& sensor_;
  Configuration of_;
  double counter_rate_ = kNetBoxRate;
  bool streams_ = false, biased_ = false;
  std::uint32_t number_ = 0, left_ = 0, sample_ = 0, failure_ = 0;
  std::array<double, 6> bias_{}, counts_{};
  Time before_{};
  std::uint32_t first_ = 0;  // counter at time 0
};

}  // namespace enc::netft
