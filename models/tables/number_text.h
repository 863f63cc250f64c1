// A number as text.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace enc::models {

// The number that is the whole text; empty: it is something else, or does not fit.
template <class Number>
[[nodiscard]] std::optional<Number> number_in(std::string_view text) {
  Number value{};
  const auto [end, bad] = std::from_chars(text.data(), text.data() + text.size(), value);
  return bad == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace enc::models
