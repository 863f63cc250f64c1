// Requests of Modbus TCP as the fake coupler receives them, and its answers. The driver's own end is
// libmodbus.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hw_drivers/gripper/wire/registers.h"

namespace enc::gripper {

inline constexpr std::size_t kHeader = 7, kMostTelegram = 260;  // bytes

struct Request {
  std::uint16_t transaction = 0;
  std::uint8_t unit = 0;
  std::uint8_t function = 0;
  std::uint16_t address = 0;
  std::uint16_t count = 0;            // coils, inputs or registers
  std::vector<std::uint16_t> values;  // written: one for each; a coil is 0 or 1
  Exception wrong = Exception::none;  // the request cannot be right
};

// Cuts a stream of bytes into requests.
class Requests {
 public:
  // The place for received bytes. Never empty unless lost().
  [[nodiscard]] std::span<std::byte> room() noexcept { return std::span(bytes_).subspan(size_); }
  void came(std::size_t count) noexcept { size_ += count; }
  // The next whole request; empty: none yet.
  [[nodiscard]] std::optional<Request> next();
  // The bytes are not Modbus TCP: the connection must be closed.
  [[nodiscard]] bool lost() const noexcept { return lost_; }
  void begin() noexcept { size_ = 0, lost_ = false; }

 private:
  std::array<std::byte, 4 * kMostTelegram> bytes_{};
  std::size_t size_ = 0;
  bool lost_ = false;
};

// The content of a telegram behind its header. It cannot fail: what is wrong stands in the request.
[[nodiscard]] Request request_of(std::span<const std::byte> telegram);

[[nodiscard]] std::vector<std::byte> refusal(const Request& request, Exception why);
// `values`: of the coils, inputs or registers that were asked for. Writes are confirmed.
[[nodiscard]] std::vector<std::byte> answer(const Request& request, std::span<const std::uint16_t> values);

}  // namespace enc::gripper
