// [driver.igtl] of a rig file.
#pragma once

#include <cstdint>
#include <string>

#include "core/spec/settings.h"

namespace enc::igtl {

struct IgtlSettings {
  std::string address = "127.0.0.1";
  std::int64_t port = 18946;
  std::string transport = "udp";
  std::string message = "TRANSFORM";
  double timeout = 0.5;      // s
  double silent = 0.5;       // s
  double least_delay = 0.0;  // s
  std::string suffix = "ToTracker";

  void declare(Settings& table);
  [[nodiscard]] bool streams() const { return transport == "tcp"; }
  [[nodiscard]] bool asks_for_tdata() const { return message == "TDATA"; }
  [[nodiscard]] std::string place() const;  // "192.168.0.21:18946"
};

}  // namespace enc::igtl
