#include "hw_drivers/netft/wire/messages.h"

#include <fmt/format.h>

#include "hw_drivers/net/big_endian.h"

namespace enc::netft {

// ---- records

namespace {

using net::put;
using net::take;

constexpr std::uint16_t kMark = 0x1234;

struct Bit {
  unsigned bit;
  const char* words;
};
// Status bits of the Net F/T; an Axia uses another table.
constexpr Bit kBits[] = {
    {30, "CPU or RAM"},
    {29, "digital board"},
    {28, "analog board"},
    {27, "serial link between the boards"},
    {26, "program memory"},
    {25, "halted by its configuration"},
    {24, "settings"},
    {23, "configuration does not fit the calibration"},
    {22, "network"},
    {21, "CAN"},
    {20, "RDT"},
    {19, "EtherNet/IP"},
    {18, "DeviceNet"},
    {17, "transducer saturated, or its converter: take load off, see that it is plugged in"},
    {16, "a threshold was met"},
    {14, "watchdog"},
    {13, "stack"},
    {12, "EEPROM"},
    {11, "flash"},
    {10, "analog watchdog"},
    {9, "excitation too high"},
    {8, "excitation too low"},
    {7, "artificial analog ground"},
    {6, "supply too high"},
    {5, "supply too low"},
    {4, "serial data"},
    {3, "reference voltage"},
    {2, "temperature"},
    {1, "HTTP"}};

}  // namespace

std::array<std::byte, kRequest> bytes_of(const Request& request) noexcept {
  std::array<std::byte, kRequest> bytes{};
  put(bytes, 0, kMark);
  put(bytes, 2, static_cast<std::uint16_t>(request.command));
  put(bytes, 4, request.samples);
  return bytes;
}

bool read(std::span<const std::byte> bytes, Request& request) noexcept {
  if (bytes.size() != kRequest || take<std::uint16_t>(bytes, 0) != kMark) return false;
  request = {static_cast<Command>(take<std::uint16_t>(bytes, 2)), take<std::uint32_t>(bytes, 4)};
  return true;
}

std::array<std::byte, kRecord> bytes_of(const Record& record) noexcept {
  std::array<std::byte, kRecord> bytes{};
  put(bytes, 0, record.number);
  put(bytes, 4, record.sample);
  put(bytes, 8, record.status);
  for (std::size_t i = 0; i < record.counts.size(); ++i) put(bytes, 12 + 4 * i, record.counts[i]);
  return bytes;
}

bool read(std::span<const std::byte> bytes, Record& record) noexcept {
  if (bytes.size() != kRecord) return false;
  record.number = take<std::uint32_t>(bytes, 0);
  record.sample = take<std::uint32_t>(bytes, 4);
  record.status = take<std::uint32_t>(bytes, 8);
  for (std::size_t i = 0; i < record.counts.size(); ++i)
    record.counts[i] = take<std::int32_t>(bytes, 12 + 4 * i);
  return true;
}

Health health_of(std::uint32_t status) noexcept {
  const std::uint32_t rest = status & ~(kError | kMonitor);
  if (rest == 0 && (status == 0 || (status & kMonitor) != 0)) return Health::ok;
  return rest == kSaturated ? Health::saturated : Health::fault;
}

std::string status_words(std::uint32_t status) {
  std::string text = fmt::format("status {:#010x}", status);
  const char* before = ": ";
  for (const Bit& one : kBits) {
    if (((status >> one.bit) & 1U) == 0) continue;
    text.append(before).append(one.words);
    before = "; ";
  }
  return text;
}

// ---- the command interface

namespace {

using net::put;
using net::take;

constexpr std::uint16_t kCommandMark = 0x1234;
constexpr std::uint16_t kBias = 1U << 0U, kClear = 1U << 1U;

}  // namespace

std::array<std::byte, kAskSize> bytes_of(const Ask& ask) noexcept {
  std::array<std::byte, kAskSize> bytes{};
  put(bytes, 0, static_cast<std::uint8_t>(ask.question));
  if (ask.question == Question::reading) {
    put(bytes, 16, ask.monitor);
    put(bytes, 18, static_cast<std::uint16_t>((ask.bias ? kBias : 0U) | (ask.clear_latch ? kClear : 0U)));
  }
  return bytes;
}

bool read(std::span<const std::byte> bytes, Ask& ask) noexcept {
  if (bytes.size() != kAskSize) return false;
  const auto question = static_cast<Question>(take<std::uint8_t>(bytes, 0));
  if (question != Question::reading && question != Question::calibration) return false;
  ask = {.question = question};
  if (question == Question::reading) {
    const auto told = take<std::uint16_t>(bytes, 18);
    ask.monitor = take<std::uint16_t>(bytes, 16);
    ask.bias = (told & kBias) != 0;
    ask.clear_latch = (told & kClear) != 0;
  }
  return true;
}

std::array<std::byte, kReadingSize> bytes_of(const Reading& reading) noexcept {
  std::array<std::byte, kReadingSize> bytes{};
  put(bytes, 0, kCommandMark);
  put(bytes, 2, reading.status);
  for (std::size_t i = 0; i < kAxes; ++i) put(bytes, 4 + 2 * i, reading.coarse[i]);
  return bytes;
}

bool read(std::span<const std::byte> bytes, Reading& reading) noexcept {
  if (bytes.size() != kReadingSize || take<std::uint16_t>(bytes, 0) != kCommandMark) return false;
  reading.status = take<std::uint16_t>(bytes, 2);
  for (std::size_t i = 0; i < kAxes; ++i) reading.coarse[i] = take<std::int16_t>(bytes, 4 + 2 * i);
  return true;
}

std::array<std::byte, kCalibrationSize> bytes_of(const Calibration& calibration) noexcept {
  std::array<std::byte, kCalibrationSize> bytes{};
  put(bytes, 0, kCommandMark);
  put(bytes, 2, calibration.force_unit);
  put(bytes, 3, calibration.torque_unit);
  put(bytes, 4, calibration.per_force);
  put(bytes, 8, calibration.per_torque);
  for (std::size_t i = 0; i < kAxes; ++i) put(bytes, 12 + 2 * i, calibration.scale[i]);
  return bytes;
}

bool read(std::span<const std::byte> bytes, Calibration& calibration) noexcept {
  if (bytes.size() != kCalibrationSize || take<std::uint16_t>(bytes, 0) != kCommandMark) return false;
  calibration.force_unit = take<std::uint8_t>(bytes, 2);
  calibration.torque_unit = take<std::uint8_t>(bytes, 3);
  calibration.per_force = take<std::uint32_t>(bytes, 4);
  calibration.per_torque = take<std::uint32_t>(bytes, 8);
  for (std::size_t i = 0; i < kAxes; ++i) calibration.scale[i] = take<std::uint16_t>(bytes, 12 + 2 * i);
  return true;
}

}  // namespace enc::netft
