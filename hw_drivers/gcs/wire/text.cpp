#include "hw_drivers/gcs/wire/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace enc::gcs {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

template <class Number>
bool read(std::string_view text, Number& number) noexcept {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);  // from_chars knows only minus
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(static_cast<double>(value)))
    return false;
  number = value;
  return true;
}

}  // namespace

Text& Text::add(std::string_view part) noexcept {
  if (part.size() > bytes_.size() - size_) {
    cut_ = true;
    return *this;
  }
  if (!part.empty()) std::memcpy(bytes_.data() + size_, part.data(), part.size());
  size_ += part.size();
  return *this;
}

Text& Text::add(double number) noexcept {
  constexpr int kDigits = 12;
  std::array<char, 32> digits{};
  const double value = number == 0.0 ? 0.0 : number;
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, kDigits);
  return add(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
}

Text& Text::add(int whole) noexcept {
  std::array<char, 16> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), whole);
  return add(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
}

bool read_number(std::string_view text, double& number) noexcept { return read(text, number); }
bool read_number(std::string_view text, int& whole) noexcept { return read(text, whole); }

std::string_view next_word(std::string_view& text) noexcept {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) {
    text = {};
    return {};
  }
  const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

std::string_view trimmed(std::string_view text) noexcept {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

}  // namespace enc::gcs
