// The words of files and messages for an enum's values, in the order of the values. Define them once, beside
// the enum:
//
//   enum class Side : std::uint8_t { left, right };
//   constexpr auto words(Side) { return enum_words("left", "right"); }
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace enc {

template <class... Word>
constexpr std::array<std::string_view, sizeof...(Word)> enum_words(const Word&... word) {
  return {std::string_view(word)...};
}

// words() of the enum, kept for the whole run of the program.
template <class Enum>
inline constexpr auto kWords = words(Enum{});

template <class Enum>
[[nodiscard]] constexpr std::string_view word_of(Enum value) {
  return kWords<Enum>[static_cast<std::size_t>(value)];
}

}  // namespace enc
