#include "hw_drivers/netft/wire/command.h"

#include "hw_drivers/net/big_endian.h"

namespace enc::netft {
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
