// [driver.netft] of a rig file.
#pragma once

#include <cstdint>
#include <string>

#include "core/spec/settings.h"

namespace enc::netft {

struct NetftSettings {
  std::string address = "192.168.1.1";
  std::int64_t port = 49152, http_port = 80, command_port = 49151;
  double timeout = 0.5;        // s
  double silent = 0.005;       // s
  double range = 130.0;        // N
  double torque_range = 10.0;  // N m
  double least_delay = 0.0;    // s
  double counter = 0.0;        // Hz; 0: measured
  std::string product = "F/T";

  void declare(Settings& table);
  [[nodiscard]] std::string place() const;  // "192.168.1.1:49152"
};

}  // namespace enc::netft
