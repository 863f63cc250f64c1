// [driver.leap] of a rig file.
#pragma once

#include <cstdint>
#include <string>

#include "core/spec/settings.h"
#include "hw_drivers/arm/fake/message.h"

namespace enc::leap {

struct LeapSettings {
  std::string library;  // empty: the installed one
  std::string server;   // empty: the usual one
  std::string mode = "headset", side = "right";
  double timeout = 2.0;  // s
  double silent = 0.5;   // s

  void declare(Settings& table);
  [[nodiscard]] std::uint32_t mode_number() const noexcept;
  // The fake's place for this service: that of `server`, or the usual one. Throws Error if `server` is
  // another name.
  [[nodiscard]] arm::Place fake_place() const;
};

inline constexpr const char* kUsualPlace = "127.0.0.1:18972";

}  // namespace enc::leap
