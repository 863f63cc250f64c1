// Integers in network order: the most significant byte first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace enc::net {

// Reads from bytes[at] on; these bytes must exist.
template <class Number>
[[nodiscard]] constexpr Number take(std::span<const std::byte> bytes, std::size_t at) noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    value = (value << 8U) | static_cast<std::uint64_t>(bytes[at + i]);
  return static_cast<Number>(static_cast<std::make_unsigned_t<Number>>(value));
}

template <class Number>
constexpr void put(std::span<std::byte> bytes, std::size_t at, Number number) noexcept {
  auto value = static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<Number>>(number));
  for (std::size_t i = sizeof(Number); i-- > 0; value >>= 8U)
    bytes[at + i] = static_cast<std::byte>(value & 0xffU);
}

}  // namespace enc::net
