// The command interface of a Net F/T over TCP: requests of 20 bytes, answers of 16 or 24, big-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hw_drivers/netft/wire/record.h"

namespace enc::netft {

inline constexpr std::size_t kAskSize = 20, kReadingSize = 16, kCalibrationSize = 24;

enum class Question : std::uint8_t { reading = 0, calibration = 1 };  // READFT, READCALINFO

struct Ask {
  Question question = Question::reading;
  std::uint16_t monitor = 0;               // READFT only: MCEnable
  bool bias = false, clear_latch = false;  // READFT only: sysCommands
};
[[nodiscard]] std::array<std::byte, kAskSize> bytes_of(const Ask& ask) noexcept;
// Returns false if the bytes are not a request, or one of another command.
[[nodiscard]] bool read(std::span<const std::byte> bytes, Ask& ask) noexcept;

struct Reading {
  std::uint16_t status = 0;                  // the upper half of the status word
  std::array<std::int16_t, kAxes> coarse{};  // counts, each divided by its axis' scale
};
[[nodiscard]] std::array<std::byte, kReadingSize> bytes_of(const Reading& reading) noexcept;
[[nodiscard]] bool read(std::span<const std::byte> bytes, Reading& reading) noexcept;

struct Calibration {
  std::uint8_t force_unit = 0, torque_unit = 0;  // codes: units.h
  std::uint32_t per_force = 0, per_torque = 0;   // counts for one unit
  std::array<std::uint16_t, kAxes> scale{};
};
[[nodiscard]] std::array<std::byte, kCalibrationSize> bytes_of(const Calibration& calibration) noexcept;
[[nodiscard]] bool read(std::span<const std::byte> bytes, Calibration& calibration) noexcept;

}  // namespace enc::netft
