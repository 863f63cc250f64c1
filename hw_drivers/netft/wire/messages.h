// The binary messages of an ATI Net F/T, big-endian: records (RDT) and its command interface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/sample.h"

namespace enc::netft {

// RDT, the raw data of an ATI Net F/T over UDP: requests of 8 bytes, records of 36, big-endian.

inline constexpr std::size_t kRequest = 8, kRecord = 36, kAxes = 6;  // Fx Fy Fz Tx Ty Tz

enum class Command : std::uint16_t {
  stop = 0,
  start = 2,
  start_buffered = 3,
  clear_latch = 0x41,
  bias = 0x42
};

struct Request {
  Command command = Command::stop;
  std::uint32_t samples = 0;  // 0: unlimited
};
[[nodiscard]] std::array<std::byte, kRequest> bytes_of(const Request& request) noexcept;
[[nodiscard]] bool read(std::span<const std::byte> bytes, Request& request) noexcept;

struct Record {
  std::uint32_t number = 0;  // counts from 1, restarts with each request
  std::uint32_t sample = 0;  // counter of the sensor's own clock
  std::uint32_t status = 0;  // 0: no fault
  std::array<std::int32_t, kAxes> counts{};
};
[[nodiscard]] std::array<std::byte, kRecord> bytes_of(const Record& record) noexcept;
[[nodiscard]] bool read(std::span<const std::byte> bytes, Record& record) noexcept;

inline constexpr std::uint32_t kError = 1U << 31U;      // any other fault
inline constexpr std::uint32_t kSaturated = 1U << 17U;  // transducer or its converter
inline constexpr std::uint32_t kMonitor = 1U << 16U;    // a threshold set by the user was met: not a fault

// Health of a record with this status, for the core.
[[nodiscard]] Health health_of(std::uint32_t status) noexcept;
// "status 0x80020000: transducer saturated"; names all set bits.
[[nodiscard]] std::string status_words(std::uint32_t status);

// The command interface of a Net F/T over TCP: requests of 20 bytes, answers of 16 or 24, big-endian.

inline constexpr std::size_t kAskSize = 20, kReadingSize = 16, kCalibrationSize = 24;

enum class Question : std::uint8_t { reading = 0, calibration = 1 };  // READFT, READCALINFO

struct Ask {
  Question question = Question::reading;
  std::uint16_t monitor = 0;               // READFT only: MCEnable
  bool bias = false, clear_latch = false;  // READFT only: sysCommands
};
[[nodiscard]] std::array<std::byte, kAskSize> bytes_of(const Ask& ask) noexcept;
// Returns false if the bytes are not a request, or are a request of another command.
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
