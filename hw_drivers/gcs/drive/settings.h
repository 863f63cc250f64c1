// [driver.gcs] of a rig file.
#pragma once

#include <cstdint>
#include <string>

#include "core/spec/settings.h"

namespace enc::gcs {

struct GcsSettings {
  std::string address = "127.0.0.1";
  std::int64_t port = 50000;
  double timeout = 0.2;     // s
  double cycle = 0.010;     // set-point cycle, s
  double poll = 0.002;      // position query interval, s
  double watchdog = 0.005;  // s
  double velocity = 0.0;    // m/s; 0: keep the controller's own
  std::string path = "points";
  double step = 3e-6;             // m
  double origin_height = 0.1845;  // m: height of the joint plane at zero, plus 30 mm to the catalogue's pivot
  std::string identity = "C-887", stage = "H-840", firmware;

  void declare(Settings& table);
  [[nodiscard]] std::string place() const;  // "192.168.0.20:50000"
};

}  // namespace enc::gcs
