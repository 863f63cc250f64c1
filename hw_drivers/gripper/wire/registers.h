// Registers of a Beckhoff EK9000 (infosys.beckhoff.com, "EK9000: Modbus TCP") and the exceptions of Modbus.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace enc::gripper {

// Word 0 of the process images holds the digital terminals.
inline constexpr int kInputImage = 0x0000, kOutputImage = 0x0800;
inline constexpr int kIdentity = 0x1000;  // seven registers of text
inline constexpr std::size_t kIdentityWords = 7;
inline constexpr int kOutputBits = 0x1012, kInputBits = 0x1013;  // numbers of digital outputs and inputs
inline constexpr int kWatchdogLeft = 0x1020;                     // ms
inline constexpr int kFallback = 0x1021;                         // 1: the watchdog has switched the outputs
inline constexpr int kBusStatus = 0x1040;                        // 1: the terminals answer the coupler
inline constexpr int kWatchdogTime = 0x1120;                     // ms
inline constexpr int kWatchdogReset = 0x1121;                    // kResetFirst, then kResetSecond
inline constexpr int kWatchdogType = 0x1122, kFallbackType = 0x1123;
inline constexpr int kWriteLock = 0x1124;
inline constexpr std::uint16_t kResetFirst = 0xbecf, kResetSecond = 0xaffe;
inline constexpr std::uint16_t kAnyTelegram = 1;  // watchdog type: every telegram feeds it
inline constexpr std::uint16_t kAllOff = 0;       // fallback type: all outputs go to 0

enum class Function : std::uint8_t {
  read_coils = 1,
  read_inputs = 2,
  read_registers = 3,
  read_input_registers = 4,
  write_coil = 5,
  write_register = 6,
  write_coils = 15,
  write_registers = 16
};

enum class Exception : std::uint8_t {
  none = 0,
  function = 1,
  address = 2,
  value = 3,
  device = 4,
  target = 11  // the unit does not answer
};
// "exception 11 (no such unit)"
[[nodiscard]] std::string exception_words(int code);

// The text in the identity registers. Couplers differ in the order of the two letters of a register:
// `swapped` reads the low byte first.
[[nodiscard]] std::string identity_of(std::span<const std::uint16_t> words, bool swapped);
[[nodiscard]] std::array<std::uint16_t, kIdentityWords> identity_words(std::string_view text);

}  // namespace enc::gripper
