#include "hw_drivers/gcs/wire/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace enc::gcs {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

template <class Number>
bool read(std::string_view text, Number& number) noexcept {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);  // from_chars only takes minus
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

// ---- commands

bool add_move(Text& text, const Coordinates& to) noexcept {
  const Coordinates wire = to_wire_units(to);
  for (const double value : wire)
    if (!std::isfinite(value)) return false;
  text.add("MOV");
  for (std::size_t i = 0; i < kAxes; ++i) text.add(' ').add(kAxisNames[i]).add(' ').add(wire[i]);
  text.add(kLineEnd);
  return true;
}

void add_velocity(Text& text, double velocity) noexcept {
  text.add("VLS ").add(millimetres(velocity)).add(kLineEnd);
}

void add_servo(Text& text, bool on) noexcept {
  text.add("SVO");
  for (const char axis : kAxisNames) text.add(' ').add(axis).add(on ? " 1" : " 0");
  text.add(kLineEnd);
}

void add_points(Text& text, double cycle) noexcept {
  text.add("SPA X 0x19001900 1").add(kLineEnd).add("SCT T ").add(1e3 * cycle).add(kLineEnd);
}
void add_own_path(Text& text) noexcept { add_line(text, "SPA X 0x19001900 0"); }

void add_line(Text& text, std::string_view words) noexcept { text.add(words).add(kLineEnd); }

// ---- answers

std::size_t AnswerReader::take(std::string_view bytes) noexcept {
  std::size_t taken = 0;
  while (taken < bytes.size() && !complete_ && !overflown()) {
    const char byte = bytes[taken++];
    const std::string_view before = answer_.view();
    complete_ = byte == '\n' && (before.empty() || before.back() != ' ');
    answer_.add(byte);
    if (overflown()) complete_ = false;
  }
  return overflown() ? bytes.size() : taken;
}

void AnswerReader::next() noexcept {
  if (overflown()) return;
  answer_.clear();
  complete_ = false;
}

bool read_axes(std::string_view answer, std::string_view axes, std::span<double> values) noexcept {
  std::uint32_t seen = 0;  // one bit for each axis
  while (!answer.empty()) {
    const std::size_t end = std::min(answer.find('\n'), answer.size());
    const std::string_view line = trimmed(answer.substr(0, end));
    answer.remove_prefix(std::min(end + 1, answer.size()));
    const std::size_t axis = line.size() < 3 || line[1] != '=' ? std::string_view::npos : axes.find(line[0]);
    if (axis == std::string_view::npos || axis >= values.size() || ((seen >> axis) & 1U) != 0) return false;
    if (!read_number(line.substr(2), values[axis])) return false;
    seen |= 1U << axis;
  }
  return seen == (1U << axes.size()) - 1;
}

bool read_single(std::string_view answer, double& number) noexcept {
  return read_number(trimmed(answer), number);
}
bool read_error(std::string_view answer, int& number) noexcept {
  return read_number(trimmed(answer), number);
}

}  // namespace enc::gcs
