#include "models/schema/printable.h"

#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace enc::models {
namespace {

// The first character of a text in UTF-8, or its first byte if that is invalid.
struct Letter {
  char32_t code;
  std::size_t bytes;
};
Letter first_letter(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const Letter alone{byte(0), 1};
  const std::size_t bytes = byte(0) < 0xC2   ? 1
                            : byte(0) < 0xE0 ? 2
                            : byte(0) < 0xF0 ? 3
                            : byte(0) < 0xF5 ? 4
                                             : 1;
  if (bytes == 1 || text.size() < bytes) return alone;
  char32_t code = byte(0) & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return alone;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  const bool half = code >= 0xD800 && code < 0xE000;  // half of a UTF-16 pair
  return code < kLeast[bytes] || code > 0x10FFFF || half ? alone : Letter{code, bytes};
}

// Characters beyond ASCII that terminals and viewers act on: C1, line and paragraph separators, and text
// direction.
bool moves_text(char32_t code) {
  return (code >= 0x80 && code < 0xA0) || code == 0x61C || code == 0x200E || code == 0x200F ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Letter letter = first_letter(text);
    if (letter.code == '\n' || letter.code == '\r' || letter.code == '\t')
      out += letter.code == '\n' ? "\\n" : letter.code == '\r' ? "\\r" : "\\t";
    else if (letter.bytes == 1 && (letter.code < ' ' || letter.code >= 127))
      out += fmt::format("\\x{:02x}", static_cast<unsigned>(letter.code));
    else if (moves_text(letter.code))
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(letter.code));
    else
      out += text.substr(0, letter.bytes);
    text.remove_prefix(letter.bytes);
  }
  return out;
}

}  // namespace enc::models
