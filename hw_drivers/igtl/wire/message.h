// Messages of OpenIGTLink: 58 bytes of header, then the content, all big-endian. A header of version 2
// (protocol 3) adds 12 bytes of extended header with the message's number before the content, and metadata
// after it. Each message is a datagram, or follows the last one in a stream.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace enc::igtl {

inline constexpr std::size_t kHeader = 58, kExtendedHeader = 12;
inline constexpr std::size_t kMostBytes = 1472;  // largest message: the content of an Ethernet datagram

// Checksum of a body, for the header: polynomial 0x42F0E1EBA9EA3693, from 0, not reflected.
[[nodiscard]] std::uint64_t crc64(std::span<const std::byte> bytes) noexcept;

// Text in a field of fixed length; a longer text is cut.
template <std::size_t kLength>
struct Name {
  std::array<char, kLength> letters{};
  Name() = default;
  explicit Name(std::string_view text) noexcept { text.copy(letters.data(), kLength); }
  std::string_view view() const&& = delete;  // the view would outlive the letters
  [[nodiscard]] std::string_view view() const& noexcept {
    const std::string_view all(letters.data(), kLength);
    return all.substr(0, all.find('\0'));
  }
};

// Reads from bytes[at] on; these bytes must exist.
template <std::size_t kLength>
[[nodiscard]] Name<kLength> take_name(std::span<const std::byte> bytes, std::size_t at) noexcept {
  Name<kLength> name;
  for (std::size_t i = 0; i < kLength; ++i) name.letters[i] = static_cast<char>(bytes[at + i]);
  return name;
}

template <std::size_t kLength>
void put_name(std::span<std::byte> bytes, std::size_t at, std::string_view text) noexcept {
  const Name<kLength> name(text);
  for (std::size_t i = 0; i < kLength; ++i) bytes[at + i] = static_cast<std::byte>(name.letters[i]);
}

struct Message {
  Name<12> type;    // "TRANSFORM", "STATUS", "STT_TRANS"
  Name<20> device;  // sending device: "stylusToTracker"
  std::int64_t stamp_ns = 0;
  bool numbered = false;
  std::uint32_t number = 0;  // valid if numbered
  // Parts of the bytes that were read: content, and metadata as pairs of words.
  std::span<const std::byte> content, metadata;
};

// no_checksum: the header has CRC 0, as from a server that does not compute it.
enum class MessageFault : std::uint8_t { nothing, cut, version, size, checksum, no_checksum };
// Returns the reason why the bytes are not a message; sets `message` if they are.
[[nodiscard]] MessageFault read(std::span<const std::byte> bytes, Message& message) noexcept;

// A message to send, in a buffer that never grows.
class OutgoingMessage {
 public:
  // Version 2, numbered, with one key and its value.
  OutgoingMessage(std::string_view type, std::string_view device, std::int64_t stamp_ns, std::uint32_t number,
                  std::span<const std::byte> content, std::string_view key = {},
                  std::string_view value = {}) noexcept;
  // Version 1, for peers that support only this version.
  OutgoingMessage(std::string_view type, std::string_view device, std::int64_t stamp_ns,
                  std::span<const std::byte> content) noexcept;
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {bytes_.data(), size_}; }

 private:
  void finish(std::uint16_t version, std::string_view type, std::string_view device,
              std::int64_t stamp_ns) noexcept;

  std::array<std::byte, 512> bytes_{};
  std::size_t size_ = 0;
};

// The value of a key in metadata; empty: the key is missing.
[[nodiscard]] std::string_view value_of(std::span<const std::byte> metadata, std::string_view key) noexcept;

// Extracts messages from a stream of bytes, in any pieces. It skips messages longer than any message of a
// tracker, such as a picture; no buffer grows.
class Stream {
 public:
  static constexpr std::size_t kMost = 1U << 13U;  // largest message: some hundred tools

  void begin() noexcept { *this = Stream(std::move(bytes_)); }  // starts another stream, with no data yet
  // Space for the next bytes; it is empty only if lost(). Call came() with the number of bytes received.
  [[nodiscard]] std::span<std::byte> room() noexcept;
  void came(std::size_t count) noexcept { end_ += count; }
  // The next message, header and body; empty: not complete yet. Valid until room() is called.
  [[nodiscard]] std::span<const std::byte> next() noexcept;
  // True if the bytes are not a header: the start of the next message is then unknown.
  [[nodiscard]] bool lost() const noexcept { return lost_; }
  [[nodiscard]] std::int64_t skipped() const noexcept { return skipped_; }  // messages that were too long

  Stream() : bytes_(kRoom) {}

 private:
  static constexpr std::size_t kRoom = 1U << 16U;
  explicit Stream(std::vector<std::byte> bytes) noexcept : bytes_(std::move(bytes)) {}

  std::vector<std::byte> bytes_;
  std::size_t begin_ = 0, end_ = 0;  // range of the bytes not yet returned
  std::uint64_t passing_ = 0;        // remaining bytes of a message that is too long
  std::int64_t skipped_ = 0;
  bool lost_ = false;
};

}  // namespace enc::igtl
