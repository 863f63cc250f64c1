// RDT, the raw data of an ATI Net F/T over UDP: requests of 8 bytes, records of 36, big-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/sample.h"

namespace enc::netft {

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

inline constexpr std::uint32_t kError = 1U << 31U;      // any of the others
inline constexpr std::uint32_t kSaturated = 1U << 17U;  // transducer or its converter
inline constexpr std::uint32_t kMonitor = 1U << 16U;    // a threshold set by the user was met: not a fault

// Health of a record with this status, for the core.
[[nodiscard]] Health health_of(std::uint32_t status) noexcept;
// "status 0x80020000: transducer saturated"; names all set bits.
[[nodiscard]] std::string status_words(std::uint32_t status);

}  // namespace enc::netft
