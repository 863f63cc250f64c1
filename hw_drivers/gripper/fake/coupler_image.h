// The fake EK9000 without its port: process image, registers and watchdog, in front of any gripper of the
// core.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/devices/device.h"
#include "hw_drivers/gripper/drive/settings.h"
#include "hw_drivers/gripper/wire/registers.h"
#include "hw_drivers/gripper/wire/requests.h"

namespace enc::gripper {

class CouplerImage {
 public:
  // The settings say how the terminals are wired; `force` is that of the rotary switch, N.
  CouplerImage(Gripper& gripper, const GripperSettings& settings, double force);

  // Answers a request at a time of the world.
  [[nodiscard]] std::vector<std::byte> answer(const Request& request, Time now);
  // The world has reached this time.
  void cycle(Time now) noexcept;
  // A fault: a Modbus exception that answers each request, kBusStatus (the terminals are cut off, the inputs
  // stand still) or kWriteLock (each write is refused); 0: none.
  void fail(int code) noexcept { failure_ = code; }
  [[nodiscard]] static bool can_fail(double code) noexcept;

  [[nodiscard]] std::int64_t switched() const noexcept { return switched_; }  // times that an output changed
  [[nodiscard]] std::int64_t fallbacks() const noexcept { return fallbacks_; }

 private:
  static constexpr std::size_t kOutputs = 8;  // one terminal, unless the wiring needs more
  [[nodiscard]] std::optional<std::uint16_t> value_of(int address, Time now) const noexcept;
  [[nodiscard]] std::vector<std::byte> read(const Request& request, Time now);
  [[nodiscard]] std::vector<std::byte> write(const Request& request, Time now);
  Exception write_output(int at, bool on) noexcept;
  Exception write_register(int at, std::uint16_t value) noexcept;
  void sense(Time now) noexcept;
  void act() noexcept;  // the outputs drive the gripper

  Gripper& gripper_;
  GripperSettings settings_;
  double force_;
  std::vector<bool> outputs_, inputs_;
  int failure_ = 0;
  std::uint16_t time_ = 1000, type_ = kAnyTelegram, fallback_type_ = kAllOff, reset_ = 0;
  bool armed_ = false, fallen_ = false;  // the watchdog: outputs were written; it ran out
  Time fed_{}, last_{};
  std::int64_t switched_ = 0, fallbacks_ = 0;
};

}  // namespace enc::gripper
