// [driver.gripper] of a rig file.
#pragma once

#include <cstdint>
#include <string>

#include "core/spec/settings.h"

namespace enc::gripper {

struct GripperSettings {
  std::string address = "192.168.1.31";
  std::int64_t port = 502, unit = 1;
  std::string product = "EK9000";
  std::int64_t open_output = 0, close_output = 1;  // coils
  std::int64_t open_input = 0, grip_input = 1;     // discrete inputs
  double timeout = 0.2;                            // s
  double poll = 0.002;                             // s
  double watchdog = 1.0;                           // s, of the coupler
  double rest = 0.02;                              // s
  double longest_stroke = 1.0;                     // s
  double closing_time = 0.21;                      // s (sources/force_sensor 4)
  double stroke = 0.008;                           // m, of each jaw
  double width = 0.006;                            // m
  double force = 100.0;                            // N

  void declare(Settings& table);
  [[nodiscard]] std::string place() const;  // "192.168.1.31:502"

 private:
  void declare_times(Settings& table);
  void declare_jaws(Settings& table);
};

}  // namespace enc::gripper
