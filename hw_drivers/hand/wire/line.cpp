#include "hw_drivers/hand/wire/line.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "core/devices/fake.h"

namespace enc::hand {
namespace {

// As str.strip() of Python has it, of ASCII.
bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r') || (c >= '\x1c' && c <= '\x1f'); }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; }

std::string_view stripped(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// The part before the next mark, which is cut off with it.
std::string_view cut(std::string_view& rest, char mark, bool& more) {
  const std::size_t at = rest.find(mark);
  more = at != std::string_view::npos;
  const std::string_view part = rest.substr(0, at);
  rest = more ? rest.substr(at + 1) : std::string_view();
  return part;
}

bool equal(std::string_view text, std::string_view word) {  // `word` in small letters
  return std::equal(text.begin(), text.end(), word.begin(), word.end(),
                    [](char a, char b) { return lower(a) == b; });
}

template <class Number>
bool number_of(std::string_view text, Number& number) {
  text = stripped(text);
  const bool plus = text.starts_with('+');
  if (plus) text.remove_prefix(1);
  if (text.empty() || (plus && text.front() == '-')) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

// What is not "letters = something" is not for us.
LineFault take_metadata(std::string_view part, Packet& packet) {
  packet.fake = packet.fake || part == kFakeName;
  std::string_view value = part;
  while (!value.empty() && is_letter(value.front())) value.remove_prefix(1);
  const std::string_view key = part.substr(0, part.size() - value.size());
  value = stripped(value);
  if (key.empty() || !value.starts_with('=') || value.size() < 2) return LineFault::nothing;
  std::int64_t number = 0;
  if (!number_of(value.substr(1), number)) return LineFault::metadata;
  if (equal(key, "f") || equal(key, "frame")) packet.frame = number;
  if (equal(key, "t") || equal(key, "ts") || equal(key, "timestamp")) packet.stamp_ns = number;
  return LineFault::nothing;
}

// Two words with space between them.
LineFault take_label(std::string_view label, Packet& packet) {
  const auto* const gap = std::find_if(label.begin(), label.end(), is_space);
  const auto first = static_cast<std::size_t>(gap - label.begin());
  const std::string_view side = label.substr(0, first), kind = stripped(label.substr(first));
  if (side == "Left") {
    packet.side = Side::left;
  } else if (side == "Right") {
    packet.side = Side::right;
  } else if (side == "Head") {
    packet.side = Side::head;
  } else {
    return LineFault::label;
  }
  if (equal(kind, "wrist")) {
    packet.kind = Kind::wrist;
  } else if (equal(kind, "landmarks")) {
    packet.kind = Kind::landmarks;
  } else if (equal(kind, "pose")) {
    packet.kind = Kind::pose;
  } else {
    return LineFault::label;
  }
  return LineFault::nothing;
}

LineFault take_head(std::string_view head, Packet& packet) {
  bool more = true;
  const std::string_view label = stripped(cut(head, '|', more));
  while (more)
    if (const LineFault wrong = take_metadata(stripped(cut(head, '|', more)), packet);
        wrong != LineFault::nothing)
      return wrong;
  return take_label(label, packet);
}

}  // namespace

LineFault read(std::string_view line, Packet& packet) noexcept {
  packet = Packet{};
  line = stripped(line);
  if (line.empty()) return LineFault::empty;
  if (!std::all_of(line.begin(), line.end(), [](char c) { return static_cast<signed char>(c) > 0; }))
    return LineFault::label;
  bool more = false;
  const std::string_view head = cut(line, ':', more);
  if (!more) return LineFault::colon;
  if (const LineFault wrong = take_head(head, packet); wrong != LineFault::nothing) return wrong;
  const std::size_t wanted = packet.kind == Kind::landmarks ? kLandmarkValues : kPoseValues;
  for (more = true; more;) {
    const std::string_view part = stripped(cut(line, ',', more));
    if (part.empty()) continue;
    double value = 0.0;
    if (!number_of(part, value) || !std::isfinite(value)) return LineFault::number;
    if (packet.count < wanted) packet.values[packet.count] = value;
    if (++packet.count > wanted) return LineFault::count;
  }
  return packet.count == wanted ? LineFault::nothing : LineFault::count;
}

std::string line_of(const Packet& packet) {
  constexpr std::array kSides{"Left", "Right", "Head"}, kKinds{"wrist", "landmarks", "pose"};
  std::string line = fmt::format("{} {}", kSides[static_cast<std::size_t>(packet.side)],
                                 kKinds[static_cast<std::size_t>(packet.kind)]);
  if (packet.frame) line += fmt::format(" | f={}", *packet.frame);
  if (packet.stamp_ns) line += fmt::format(" | t={}", *packet.stamp_ns);
  if (packet.fake) line += fmt::format(" | {}", kFakeName);
  for (std::size_t i = 0; i < packet.count; ++i)
    fmt::format_to(std::back_inserter(line), "{} {}", i == 0 ? ":" : ",", packet.values[i]);
  return line + "\n";
}

std::span<std::byte> Lines::room() noexcept {
  if (begin_ > 0) {
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_),
              bytes_.begin() + static_cast<std::ptrdiff_t>(size_), bytes_.begin());
    size_ -= begin_;
    begin_ = 0;
  }
  if (size_ == bytes_.size()) {  // no line ends here
    skipped_ += skips_ ? 0 : 1;
    skips_ = true;
    size_ = 0;
  }
  return std::as_writable_bytes(std::span(bytes_).subspan(size_));
}

std::optional<std::string_view> Lines::next() noexcept {
  while (begin_ < size_) {
    const std::string_view all(bytes_.data() + begin_, size_ - begin_);
    const std::size_t end = all.find('\n');
    if (end == std::string_view::npos) return {};
    begin_ += end + 1;
    if (!std::exchange(skips_, false)) return all.substr(0, end);
  }
  return {};
}

}  // namespace enc::hand
