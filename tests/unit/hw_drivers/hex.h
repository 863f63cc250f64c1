// Bytes in a person's notation: "1234 0002 00000000".
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace enc::tests {

inline std::string hex(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::byte one : bytes) {
    text.push_back(kDigits[std::to_integer<unsigned>(one) >> 4U]);
    text.push_back(kDigits[std::to_integer<unsigned>(one) & 15U]);
  }
  return text;
}

inline std::vector<std::byte> from_hex(std::string_view text) {
  std::vector<std::byte> all;
  unsigned value = 0;
  bool half = false;
  for (const char c : text) {
    if (c == ' ') continue;
    value = 16 * value + static_cast<unsigned>(c >= 'a' ? c - 'a' + 10 : c - '0');
    if (half) all.push_back(static_cast<std::byte>(value));
    value = half ? 0 : value;
    half = !half;
  }
  return all;
}

}  // namespace enc::tests
