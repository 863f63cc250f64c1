// [driver.hand] of a rig file.
#pragma once

#include <cstdint>
#include <string>

#include "core/spec/settings.h"

namespace enc::hand {

struct HandSettings {
  std::string address = "0.0.0.0", transport = "udp", side = "right", landmarks = "wrist";
  std::int64_t port = 9000;
  double timeout = 1.0;       // s
  double silent = 0.5;        // s
  double least_delay = 0.03;  // s (sources/hand 7)
  double skin = 0.008;        // m

  void declare(Settings& table);
  [[nodiscard]] bool streams() const { return transport == "tcp"; }
  [[nodiscard]] bool from_wrist() const { return landmarks == "wrist"; }
  [[nodiscard]] std::string place() const;  // "192.168.1.41:8000"
};

}  // namespace enc::hand
