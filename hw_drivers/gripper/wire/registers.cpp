#include "hw_drivers/gripper/wire/registers.h"

#include <fmt/format.h>

namespace enc::gripper {

std::string exception_words(int code) {
  const auto words = [code] {
    switch (static_cast<Exception>(code)) {
      case Exception::function:
        return "it does not know the function";
      case Exception::address:
        return "it has no such register, input or output";
      case Exception::value:
        return "it refuses the value";
      case Exception::device:
        return "it cannot do that now";
      case Exception::target:
        return "no such unit";
      default:
        return "of Modbus";
    }
  };
  return fmt::format("exception {} ({})", code, words());
}

std::string identity_of(std::span<const std::uint16_t> words, bool swapped) {
  std::string text;
  for (const std::uint16_t word : words) {
    const auto high = static_cast<char>(word >> 8U), low = static_cast<char>(word & 0xffU);
    text += swapped ? low : high;
    text += swapped ? high : low;
  }
  if (const std::size_t end = text.find('\0'); end != std::string::npos) text.resize(end);
  return text;
}

std::array<std::uint16_t, kIdentityWords> identity_words(std::string_view text) {
  std::array<std::uint16_t, kIdentityWords> words{};
  for (std::size_t i = 0; i < text.size() && i < 2 * kIdentityWords; ++i) {
    const auto letter = static_cast<std::uint16_t>(static_cast<unsigned char>(text[i]));
    words[i / 2] = static_cast<std::uint16_t>(words[i / 2] | (letter << (i % 2 == 0 ? 0U : 8U)));
  }
  return words;
}

}  // namespace enc::gripper
