// Words in files and messages: those of an enum's values, and a count with its noun.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace enc {

// The words of files and messages for an enum's values, in the order of the values. Define them once, beside
// the enum:
//
//   enum class Side : std::uint8_t { left, right };
//   constexpr auto words(Side) { return enum_words("left", "right"); }
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

// Text such as "1 contact", "2 contacts", "0 passes": a count and its noun. `one` is the singular noun; its
// last word gets the plural ending.
template <class Count>
[[nodiscard]] std::string counted(Count count, std::string_view one) {
  std::string text = std::to_string(count).append(" ").append(one);
  if (count == Count{1}) return text;
  const bool hisses = one.ends_with("s") || one.ends_with("x") || one.ends_with("sh") || one.ends_with("ch");
  return text.append(hisses ? "es" : "s");
}

}  // namespace enc
