#include "hw_drivers/igtl/wire/message.h"

#include <algorithm>

#include "hw_drivers/net/big_endian.h"

namespace enc::igtl {
namespace {

constexpr std::uint64_t kBillion = 1'000'000'000;

using net::put;
using net::take;

constexpr std::array<std::uint64_t, 256> crc_table() noexcept {
  std::array<std::uint64_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::uint64_t value = static_cast<std::uint64_t>(i) << 56U;
    for (int bit = 0; bit < 8; ++bit)
      value = (value << 1U) ^ ((value >> 63U) != 0 ? 0x42F0E1EBA9EA3693ULL : 0ULL);
    table[i] = value;
  }
  return table;
}

}  // namespace

std::uint64_t crc64(std::span<const std::byte> bytes) noexcept {
  static constexpr std::array<std::uint64_t, 256> kTable = crc_table();
  std::uint64_t crc = 0;
  for (const std::byte byte : bytes)
    crc = kTable[static_cast<std::size_t>((crc >> 56U) ^ static_cast<std::uint64_t>(byte))] ^ (crc << 8U);
  return crc;
}

MessageFault read(std::span<const std::byte> bytes, Message& message) noexcept {
  if (bytes.size() < kHeader) return MessageFault::cut;
  const auto version = take<std::uint16_t>(bytes, 0);
  if (version != 1 && version != 2) return MessageFault::version;
  const std::span<const std::byte> body = bytes.subspan(kHeader);
  if (take<std::uint64_t>(bytes, 42) != body.size()) return MessageFault::size;
  const auto checksum = take<std::uint64_t>(bytes, 50);
  if (checksum != crc64(body)) return checksum == 0 ? MessageFault::no_checksum : MessageFault::checksum;
  Message read;
  read.type = take_name<12>(bytes, 2);
  read.device = take_name<20>(bytes, 14);
  const auto fraction = static_cast<std::uint64_t>(take<std::uint32_t>(bytes, 38));
  read.stamp_ns = static_cast<std::int64_t>(take<std::uint32_t>(bytes, 34) * kBillion +
                                            ((fraction * kBillion + (1ULL << 31U)) >> 32U));
  read.content = body;
  if (version == 2) {
    if (body.size() < kExtendedHeader) return MessageFault::size;
    const std::size_t extended = take<std::uint16_t>(body, 0);
    const std::size_t behind = std::size_t{take<std::uint16_t>(body, 2)} + take<std::uint32_t>(body, 4);
    if (extended < kExtendedHeader || extended > body.size() || behind > body.size() - extended)
      return MessageFault::size;
    read.numbered = true;
    read.number = take<std::uint32_t>(body, 8);
    read.content = body.subspan(extended, body.size() - extended - behind);
    read.metadata = body.last(behind);
  }
  message = read;
  return MessageFault::nothing;
}

OutgoingMessage::OutgoingMessage(std::string_view type, std::string_view device, std::int64_t stamp_ns,
                                 std::uint32_t number, std::span<const std::byte> content,
                                 std::string_view key, std::string_view value) noexcept {
  constexpr std::size_t kCount = 2, kPair = 8;
  constexpr std::uint16_t kAscii = 3;
  const std::size_t header = kCount + (key.empty() ? 0 : kPair), text = key.size() + value.size();
  const std::size_t room = bytes_.size() - kHeader - kExtendedHeader;
  const std::size_t fits = std::min(content.size(), room - std::min(room, header + text));
  size_ = std::min(bytes_.size(), kHeader + kExtendedHeader + fits + header + text);
  const std::span<std::byte> all(bytes_.data(), size_);
  const std::span<std::byte> body = all.subspan(kHeader);
  put(body, 0, static_cast<std::uint16_t>(kExtendedHeader));
  put(body, 2, static_cast<std::uint16_t>(header));
  put(body, 4, static_cast<std::uint32_t>(text));
  put(body, 8, number);
  const std::span<std::byte> behind = body.subspan(kExtendedHeader + fits);
  if (!key.empty()) {
    put(behind, 0, std::uint16_t{1});
    put(behind, 2, static_cast<std::uint16_t>(key.size()));
    put(behind, 4, kAscii);
    put(behind, 6, static_cast<std::uint32_t>(value.size()));
    const auto letters = std::as_bytes(std::span(key)), words = std::as_bytes(std::span(value));
    std::copy(letters.begin(), letters.end(), behind.begin() + static_cast<std::ptrdiff_t>(header));
    std::copy(words.begin(), words.end(), behind.begin() + static_cast<std::ptrdiff_t>(header + key.size()));
  }
  std::copy_n(content.begin(), fits, body.begin() + kExtendedHeader);
  finish(2, type, device, stamp_ns);
}

OutgoingMessage::OutgoingMessage(std::string_view type, std::string_view device, std::int64_t stamp_ns,
                                 std::span<const std::byte> content) noexcept {
  size_ = std::min(bytes_.size(), kHeader + content.size());
  std::copy_n(content.begin(), size_ - kHeader, bytes_.begin() + kHeader);
  finish(1, type, device, stamp_ns);
}

// Writes the header in front of the finished body.
void OutgoingMessage::finish(std::uint16_t version, std::string_view type, std::string_view device,
                             std::int64_t stamp_ns) noexcept {
  const std::span<std::byte> all(bytes_.data(), size_), body = all.subspan(kHeader);
  const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(stamp_ns, 0));
  put(all, 0, version);
  put_name<12>(all, 2, type);
  put_name<20>(all, 14, device);
  put(all, 34, static_cast<std::uint32_t>(ns / kBillion));
  put(all, 38, static_cast<std::uint32_t>(((ns % kBillion) << 32U) / kBillion));
  put(all, 42, static_cast<std::uint64_t>(body.size()));
  put(all, 50, crc64(body));
}

std::string_view value_of(std::span<const std::byte> metadata, std::string_view key) noexcept {
  if (metadata.size() < 2) return {};
  const std::size_t count = take<std::uint16_t>(metadata, 0);
  const std::size_t header = 2 + 8 * count;
  if (header > metadata.size()) return {};
  std::string_view text(reinterpret_cast<const char*>(metadata.data()) + header, metadata.size() - header);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t letters = take<std::uint16_t>(metadata, 2 + 8 * i);
    const std::size_t words = take<std::uint32_t>(metadata, 6 + 8 * i);
    if (letters > text.size() || words > text.size() - letters) return {};
    if (text.substr(0, letters) == key) return text.substr(letters, words);
    text.remove_prefix(letters + words);
  }
  return {};
}

// ---- streams

namespace {

// Accepts headers of any version: the first byte is 0, and the type's name holds letters, digits or '_',
// padded with zeros.
bool is_header(std::span<const std::byte> bytes) noexcept {
  const auto name = take_name<12>(bytes, 2);
  const std::string_view type = name.view();
  const bool words = !type.empty() && std::all_of(type.begin(), type.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
  const bool zeros = std::all_of(name.letters.begin() + static_cast<std::ptrdiff_t>(type.size()),
                                 name.letters.end(), [](char c) { return c == '\0'; });
  return bytes[0] == std::byte{0} && words && zeros;
}

}  // namespace

std::span<std::byte> Stream::room() noexcept {
  if (begin_ == end_) begin_ = end_ = 0;
  if (begin_ > 0 && end_ == bytes_.size()) {
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_),
              bytes_.begin() + static_cast<std::ptrdiff_t>(end_), bytes_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  return std::span(bytes_).subspan(end_);
}

std::span<const std::byte> Stream::next() noexcept {
  while (!lost_) {
    const auto passed = static_cast<std::size_t>(std::min<std::uint64_t>(passing_, end_ - begin_));
    begin_ += passed;
    passing_ -= passed;
    const std::span<const std::byte> there = std::span(bytes_).subspan(begin_, end_ - begin_);
    if (there.size() < kHeader) return {};
    lost_ = !is_header(there);
    if (lost_) return {};
    const auto body = net::take<std::uint64_t>(there, 42);
    if (body > kMost - kHeader) {
      begin_ += kHeader;
      passing_ = body;
      ++skipped_;
      continue;
    }
    const std::size_t whole = kHeader + static_cast<std::size_t>(body);
    if (there.size() < whole) return {};
    begin_ += whole;
    return there.first(whole);
  }
  return {};
}

}  // namespace enc::igtl
